# obscura_shaders(<target> <namespace> [ROOT <folder>] <name>...)
# Compiles shaders, named relative to the folder (the project's shaders/), and adds to the target a source file that defines
#   std::span<const gpu::EmbeddedShader> obscura::<namespace>::shaders()
# A line `#pragma variant A,B=2` in a shader adds <name>:A,B=2, compiled with these macros. Edits of a shader or of anything it includes
# rebuild it. The target links obscura_gpu.
set_property(GLOBAL PROPERTY OBSCURA_SHADER_ROOT ${CMAKE_CURRENT_LIST_DIR}/../../shaders)

function(obscura_shaders target namespace)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "ROOT" "")
  set(root ${arg_ROOT})
  if(NOT root)
    get_property(root GLOBAL PROPERTY OBSCURA_SHADER_ROOT)
    get_filename_component(root ${root} ABSOLUTE)
  endif()
  set(out ${CMAKE_CURRENT_BINARY_DIR}/${target}_shaders.cpp)
  list(TRANSFORM arg_UNPARSED_ARGUMENTS PREPEND ${root}/ OUTPUT_VARIABLE sources)
  add_custom_command(
    OUTPUT ${out}
    COMMAND obscura-compile-shaders --root ${root} --namespace ${namespace} --out ${out} --depfile ${out}.d
            $<$<CONFIG:Debug>:--names> ${arg_UNPARSED_ARGUMENTS}
    DEPENDS obscura-compile-shaders ${sources}
    DEPFILE ${out}.d
    COMMENT "Compiling shaders of ${target}"
    COMMAND_EXPAND_LISTS VERBATIM)
  target_sources(${target} PRIVATE ${out})
endfunction()
