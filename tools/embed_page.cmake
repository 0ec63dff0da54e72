# Writes a page's files (NAME.html, .css, .js) as C++ strings of a namespace:
#   cmake -DPAGE=folder -DNAME=gallery -DNAMESPACE=obscura::evaluate -DOUT=page.cpp -P embed_page.cmake
set(text "// Generated from ${NAME}.html, .css and .js. Do not edit.\n#include \"page.h\"\n\nnamespace ${NAMESPACE} {\n\n")
foreach(kind html css js)
  string(SUBSTRING ${kind} 0 1 first)
  string(TOUPPER ${first} first)
  string(SUBSTRING ${kind} 1 -1 rest)
  file(READ ${PAGE}/${NAME}.${kind} content)
  string(APPEND text "const char* const kPage${first}${rest} = R\"~page~(${content})~page~\";\n\n")
endforeach()
file(WRITE ${OUT} "${text}}  // namespace ${NAMESPACE}\n")
