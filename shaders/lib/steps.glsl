// Does one surface end in front of another?
//
// Compares the heights of two neighbouring pixels' points over each other's tangent planes. Where a surface bends, even
// strongly, both lie below the other's plane, or both above. Where one ends in front of the other, the nearer lies
// above and the farther below.

// `step`: the smallest that counts, in footprints of a pixel.
bool isStepBetween(vec3 pointA, vec3 normalA, vec3 pointB, vec3 normalB, float footprint, float step) {
    vec3 between = pointB - pointA;
    float ofB = dot(between, normalA), ofA = -dot(between, normalB);
    // A fiftieth of a pixel is some hundred times the rounding of depths.
    bool apart = ofA * ofB < 0.0 && min(abs(ofA), abs(ofB)) > 0.02 * footprint;
    return apart && max(abs(ofA), abs(ofB)) > step * footprint;
}
