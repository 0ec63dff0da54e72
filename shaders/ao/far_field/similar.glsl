// Neighbours that interleaving averages, by the paper's test: normals within 60 degrees, depths within 3 % [Timonen 2013, sec. 10]. The
// other test, ofSurface() in ao/common/tile.glsl, asks for the tangent plane: on grazing surfaces neighbours differ by more than 3 %, and
// steps of less are no single surface.
#ifndef OBSCURA_FAR_FIELD_SIMILAR_GLSL
#define OBSCURA_FAR_FIELD_SIMILAR_GLSL

bool similar(vec3 here, vec3 n, float depth, vec3 there, vec3 m) { return dot(n, m) > 0.5 && abs(there.z - here.z) < 0.03 * depth; }

#endif
