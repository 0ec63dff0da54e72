// Size and layout of the falloff's table (table.comp): phi / pi over columns, b / (b + unit) over rows, both from edge to edge.
#ifndef OBSCURA_FAR_FIELD_TABLE_GLSL
#define OBSCURA_FAR_FIELD_TABLE_GLSL
#include "ao/common/arcs.glsl"
const uint kTableColumns = 64u, kTableRows = 128u;
#endif
