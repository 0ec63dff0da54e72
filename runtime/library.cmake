# obscura_library(<target>): settings of targets whose objects become the installed libraries. A host may use another version of
# fmt, or the same built otherwise: the library's own copy, compiled from headers, has a namespace of its own. Functions without
# OBSCURA_API are hidden, and templates' static members are no process-wide symbols, which objcopy could not make local.
function(obscura_library target)
  set_target_properties(${target} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  target_compile_definitions(${target} PRIVATE fmt=obscura_fmt)
  if(NOT WIN32)
    target_compile_definitions(${target} PRIVATE OBSCURA_EXPORTS)
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fno-gnu-unique>)
  endif()
endfunction()
