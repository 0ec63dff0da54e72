# For doxygen: the plain comments of ao.h as documentation. `//` above a declaration, behind one (and the lines on which that one goes on).
# Macros are left out.
1s|^//|/// @file\n///|
/^#define OBSCURA_VERSION_MAJOR/,/^#endif/d
/^\/\/ ----/d
s/^OBSCURA_API //
s|^( {12,})// |\1///< |
s|^( *)//( .*)?$|\1///\2|
s|^( *[^ /].*[^ ]) +// |\1  ///< |
