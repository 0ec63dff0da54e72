# Writes a page's files (NAME.html: the body; NAME.css, NAME.js) as C++ strings in a namespace; with BASE, style and script follow those of
# page/base.*:
#   cmake -DPAGE=folder -DNAME=gallery -DNAMESPACE=obscura::evaluate -DOUT=page.cpp [-DBASE=ON] -P embed_page.cmake
set(text "// Generated from ${NAME}.html, .css and .js. Do not edit.\n#include \"page.h\"\n\nnamespace ${NAMESPACE} {\n\n")
foreach(kind html css js)
  string(SUBSTRING ${kind} 0 1 first)
  string(TOUPPER ${first} first)
  string(SUBSTRING ${kind} 1 -1 rest)
  set(shared "")
  if(BASE AND NOT kind STREQUAL html)
    file(READ ${CMAKE_CURRENT_LIST_DIR}/page/base.${kind} shared)
  endif()
  file(READ ${PAGE}/${NAME}.${kind} content)
  # Two literals, because compilers limit the length of one.
  string(APPEND text "const char* const kPage${first}${rest} = R\"~page~(${shared})~page~\"\nR\"~page~(${content})~page~\";\n\n")
endforeach()
file(WRITE ${OUT} "${text}}  // namespace ${NAMESPACE}\n")
