// The same as geometry_fast.
#include "effects/geometry/fast.frag"
