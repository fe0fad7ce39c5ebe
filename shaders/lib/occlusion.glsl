// The meaning of ambient occlusion in every technique: an occluder counts up to the radius, and less the farther it is
// (rays/falloff.h).

#define FALLOFF_NONE 0
#define FALLOFF_LINEAR 1
#define FALLOFF_QUADRATIC 2

// w(d/R) of a squared share (d/R)² that is at most 1.
float falloffWeight(float squaredShare) {
#if FALLOFF == FALLOFF_LINEAR
    return 1.0 - sqrt(squaredShare);
#elif FALLOFF == FALLOFF_QUADRATIC
    return 1.0 - squaredShare;
#else
    return 1.0;
#endif
}
