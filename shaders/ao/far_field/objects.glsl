// Objects: surfaces with a known back in front of the background. Depths are unit / depth.
// - A pixel (fields.comp): front as a float, whose lowest byte is the thickness (front - back) / front as a power of 2, in 16ths; growth of
//   the front per pixel to the right and downwards, as halves.
// - A cell: means over all pixels of an interval, covered or not, so that cells of longer intervals and more lines are means of cells:
//   front where covered, as a float, whose lowest byte is the coverage; thickness there, (front - back) / front, and, times
//   coverage, the growth of the front over the interval, as halves. One cell serves a direction and its opposite.
// The low byte of a front stays when it is read: fronts are exact to 2^-15.
#ifndef OBSCURA_FAR_FIELD_THINGS_GLSL
#define OBSCURA_FAR_FIELD_THINGS_GLSL

uint packSurface(float front, float back) {
    float sixteenths = -16.0 * log2(max((front - back) / front, 1.5e-5));
    return bitfieldInsert(floatBitsToUint(front), uint(clamp(sixteenths + 0.5, 0.0, 255.0)), 0, 8);
}
vec2 unpackSurface(uint packed) {  // front, back
    float front = uintBitsToFloat(packed);
    return vec2(front, front - front * exp2(float(packed & 255u) * (-1.0 / 16.0)));
}

// front, back and growth times coverage, coverage: (front, back, coverage, growth)
uvec2 packObject(vec4 object) {
    uint covered = uint(clamp(object.z * 255.0 + 0.5, 0.0, 255.0));
    if (covered == 0u) return uvec2(0u);
    return uvec2(bitfieldInsert(floatBitsToUint(object.x / object.z), covered, 0, 8),
        packHalf2x16(vec2((object.x - object.y) / object.x, clamp(object.w, -60000.0, 60000.0))));
}
vec4 unpackObject(uvec2 cell) {
    float covered = float(cell.x & 255u) * (1.0 / 255.0), front = uintBitsToFloat(cell.x) * covered;
    vec2 rest = unpackHalf2x16(cell.y);
    return vec4(front, front - front * rest.x, covered, rest.y);
}

#endif
