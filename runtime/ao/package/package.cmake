# What is installed: the three modules gpu, graph and ao as a static and a shared library, the public header, and what
# find_package(Obscura), pkg-config and dpkg want to know. Both libraries are made of the same objects. Neither needs anything
# but the C++ runtime: shaders are embedded as SPIR-V, fmt is taken as headers, and the host brings the Vulkan loader. Neither
# defines a symbol of fmt: runtime/library.cmake renames it. Where GNU binutils make ELF, both define the API's symbols alone.
set(OBSCURA_SUMMARY "Ambient-obscurance methods for Vulkan 1.3")
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
include(CheckLinkerFlag)

# device_create and loader make a device of the sample's own, which takes the Vulkan loader; a host has its device.
# exporting: the files of runtime/ao that define the functions of ao.h.
set(exporting context context_create context_method falloff registry)
list(JOIN exporting | exporting_pattern)
set(objects)
set(hidden_objects)
foreach(module gpu graph ao)
  list(APPEND objects $<FILTER:$<TARGET_OBJECTS:obscura_${module}>,EXCLUDE,/\(device_create|loader\)\\.cpp\\.>)
  list(APPEND hidden_objects $<FILTER:$<TARGET_OBJECTS:obscura_${module}>,EXCLUDE,/\(device_create|loader|${exporting_pattern}\)\\.cpp\\.>)
endforeach()

# The static library. With GNU ld and objcopy for ELF: one object, linked once, in which every symbol but the API's is local, so that
# nothing in it can meet a symbol of the host's. Elsewhere, and with sanitizers, the objects as they are.
set(prelinked OFF)
if(CMAKE_EXECUTABLE_FORMAT STREQUAL ELF AND CMAKE_LINKER AND CMAKE_OBJCOPY AND NOT OBSCURA_SANITIZE
    AND NOT CMAKE_INTERPROCEDURAL_OPTIMIZATION)
  execute_process(COMMAND ${CMAKE_LINKER} --help OUTPUT_VARIABLE linker_help ERROR_QUIET)
  if(linker_help MATCHES "--force-group-allocation")  # GNU ld 2.29 and later; others would keep COMDAT groups, which a host's may replace
    set(prelinked ON)
  endif()
endif()
if(prelinked)
  set(object ${CMAKE_CURRENT_BINARY_DIR}/obscura-ao.o)
  add_custom_command(OUTPUT ${object}
    COMMAND ${CMAKE_LINKER} -r --force-group-allocation -o ${object}.all ${objects}
    COMMAND ${CMAKE_OBJCOPY} --wildcard --localize-hidden --keep-global-symbol=_ZN7obscura2ao* ${object}.all ${object}
    COMMAND ${CMAKE_COMMAND} -E rm -f ${object}.all
    DEPENDS ${objects} COMMENT "Linking obscura-ao.o" COMMAND_EXPAND_LISTS VERBATIM)
  set_source_files_properties(${object} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
  add_library(obscura_ao_static STATIC ${object})
else()
  add_library(obscura_ao_static STATIC ${objects})
endif()

# The shared library. A DLL's exported functions are compiled once more, as exported ones, so that the static library exports nothing.
if(WIN32)
  list(TRANSFORM exporting REPLACE "(.+)" "${PROJECT_SOURCE_DIR}/runtime/ao/\\1.cpp")
  add_library(obscura_ao_shared SHARED ${hidden_objects} ${exporting})
  obscura_library(obscura_ao_shared)
  target_compile_definitions(obscura_ao_shared PRIVATE OBSCURA_EXPORTS)
  target_include_directories(obscura_ao_shared PRIVATE $<TARGET_PROPERTY:obscura_ao,INCLUDE_DIRECTORIES>)
  target_link_libraries(obscura_ao_shared PRIVATE $<BUILD_INTERFACE:fmt::fmt-header-only>)
else()
  add_library(obscura_ao_shared SHARED ${objects})
endif()
set(exports ${CMAKE_CURRENT_LIST_DIR}/exports.map)
check_linker_flag(CXX "-Wl,--version-script=${exports}" OBSCURA_VERSION_SCRIPT)
if(OBSCURA_VERSION_SCRIPT AND CMAKE_EXECUTABLE_FORMAT STREQUAL ELF)
  target_link_options(obscura_ao_shared PRIVATE "-Wl,--version-script=${exports}")
  if(NOT OBSCURA_SANITIZE)
    target_link_options(obscura_ao_shared PRIVATE -Wl,--no-undefined)
  endif()
endif()
set_target_properties(obscura_ao_shared PROPERTIES LINK_DEPENDS ${exports} VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR})
foreach(kind static shared)
  set_target_properties(obscura_ao_${kind} PROPERTIES OUTPUT_NAME obscura-ao EXPORT_NAME ao_${kind} LINKER_LANGUAGE CXX)
  target_compile_features(obscura_ao_${kind} INTERFACE cxx_std_17)
  target_link_libraries(obscura_ao_${kind} INTERFACE Vulkan::Headers)
  add_dependencies(obscura_ao_${kind} obscura_gpu obscura_graph obscura_ao)
endforeach()
if(MSVC)  # else the DLL's import library and the static library would have one name
  set_target_properties(obscura_ao_static PROPERTIES OUTPUT_NAME obscura-ao-static)
endif()

if(NOT OBSCURA_INSTALL)
  return()
endif()

set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Obscura)
install(TARGETS obscura_ao_static obscura_ao_shared EXPORT Obscura INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/runtime/ao/include/obscura DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT Obscura NAMESPACE Obscura:: FILE ObscuraTargets.cmake DESTINATION ${config_folder})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/ObscuraConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/ObscuraConfig.cmake
  INSTALL_DESTINATION ${config_folder})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/ObscuraConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/ObscuraConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/ObscuraConfigVersion.cmake
  DESTINATION ${config_folder})

# What a static library asks of a C linker's command line: the C++ runtime of the compiler that built it.
if(MSVC)
  set(OBSCURA_LIBS_PRIVATE "")
elseif(CMAKE_CXX_IMPLICIT_LINK_LIBRARIES MATCHES "(^|;)c\\+\\+(;|$)")
  set(OBSCURA_LIBS_PRIVATE "-lc++ -lm")
else()
  set(OBSCURA_LIBS_PRIVATE "-lstdc++ -lm")
endif()
file(RELATIVE_PATH PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" PC_PREFIX "${PC_PREFIX}")
configure_file(${CMAKE_CURRENT_LIST_DIR}/obscura-ao.pc.in ${CMAKE_CURRENT_BINARY_DIR}/obscura-ao.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/obscura-ao.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libobscura-ao-dev RENAME copyright)
install(FILES ${PROJECT_SOURCE_DIR}/runtime/ao/NOTICES.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libobscura-ao-dev)

if(PROJECT_IS_TOP_LEVEL AND CMAKE_SYSTEM_NAME STREQUAL Linux)
  set(CPACK_GENERATOR DEB)
  set(CPACK_PACKAGE_NAME libobscura-ao-dev)
  set(CPACK_PACKAGE_VENDOR Obscura)
  set(CPACK_PACKAGE_CONTACT "The Obscura authors <obscura@example.org>")
  set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${OBSCURA_SUMMARY}")
  set(CPACK_PACKAGE_DESCRIPTION "Libraries (static and shared), header, CMake package and pkg-config file. Depth in, visibility out.")
  set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR})
  set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
  set(CPACK_STRIP_FILES ON)
  set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
  set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)          # finds libc6, libgcc-s1, libstdc++6 and their versions
  set(CPACK_DEBIAN_PACKAGE_DEPENDS libvulkan-dev)  # the header includes Vulkan's
  set(CPACK_DEBIAN_PACKAGE_SUGGESTS "cmake, pkg-config")
  set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
  include(CPack)
endif()
