# Toolchain file: cross-compiles the library for 64-bit Windows by mingw-w64 on a Debian-like machine (preset mingw).
#   apt-get install g++-mingw-w64-x86-64-posix, beside what the library needs natively
# mingw-w64 brings neither Vulkan's headers nor fmt's, and headers are the same for every system: ${CMAKE_BINARY_DIR}/sysroot links to
# those of OBSCURA_HEADERS, and holds an import library of the functions that the loader vulkan-1.dll exports.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(prefix x86_64-w64-mingw32)
find_program(CMAKE_C_COMPILER NAMES ${prefix}-gcc-posix ${prefix}-gcc REQUIRED)
find_program(CMAKE_CXX_COMPILER NAMES ${prefix}-g++-posix ${prefix}-g++ REQUIRED)
find_program(CMAKE_RC_COMPILER NAMES ${prefix}-windres)
# The C++ runtime goes into each program and DLL.
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
set(CMAKE_SHARED_LINKER_FLAGS_INIT -static)

set(OBSCURA_HEADERS /usr/include CACHE PATH "Folder of the headers vulkan/, vk_video/ and fmt/")
get_property(trying GLOBAL PROPERTY IN_TRY_COMPILE)
if(NOT OBSCURA_SYSROOT)
  set(OBSCURA_SYSROOT "${CMAKE_BINARY_DIR}/sysroot")
endif()
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES OBSCURA_SYSROOT)
if(NOT trying AND NOT EXISTS "${OBSCURA_SYSROOT}/lib/libvulkan-1.dll.a")
  file(MAKE_DIRECTORY "${OBSCURA_SYSROOT}/include" "${OBSCURA_SYSROOT}/lib/cmake/fmt")
  foreach(folder vulkan vk_video fmt)
    if(NOT EXISTS "${OBSCURA_HEADERS}/${folder}")
      message(FATAL_ERROR "${OBSCURA_HEADERS}/${folder} does not exist; set OBSCURA_HEADERS to the folder of Vulkan's and fmt's headers")
    endif()
    file(CREATE_LINK "${OBSCURA_HEADERS}/${folder}" "${OBSCURA_SYSROOT}/include/${folder}" SYMBOLIC)
  endforeach()
  file(WRITE "${OBSCURA_SYSROOT}/lib/cmake/fmt/fmt-config.cmake" [[
add_library(fmt::fmt-header-only INTERFACE IMPORTED)
set_target_properties(fmt::fmt-header-only PROPERTIES INTERFACE_COMPILE_DEFINITIONS FMT_HEADER_ONLY
  INTERFACE_INCLUDE_DIRECTORIES "${CMAKE_CURRENT_LIST_DIR}/../../../include")
]])
  # Names of the functions that vulkan_core.h declares.
  file(STRINGS "${OBSCURA_HEADERS}/vulkan/vulkan_core.h" lines REGEX "VKAPI_ATTR .* VKAPI_CALL vk[A-Za-z0-9]+\\(")
  set(definition "LIBRARY vulkan-1.dll\nEXPORTS\n")
  foreach(line IN LISTS lines)
    if(line MATCHES "VKAPI_CALL (vk[A-Za-z0-9]+)")
      string(APPEND definition "  ${CMAKE_MATCH_1}\n")
    endif()
  endforeach()
  file(WRITE "${OBSCURA_SYSROOT}/lib/vulkan-1.def" "${definition}")
  find_program(OBSCURA_DLLTOOL NAMES ${prefix}-dlltool REQUIRED)
  execute_process(
    COMMAND "${OBSCURA_DLLTOOL}" -d "${OBSCURA_SYSROOT}/lib/vulkan-1.def" -l "${OBSCURA_SYSROOT}/lib/libvulkan-1.dll.a"
    COMMAND_ERROR_IS_FATAL ANY)
endif()

set(CMAKE_FIND_ROOT_PATH /usr/${prefix} "${OBSCURA_SYSROOT}")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
foreach(kind LIBRARY INCLUDE PACKAGE)
  set(CMAKE_FIND_ROOT_PATH_MODE_${kind} ONLY)
endforeach()
set(Vulkan_INCLUDE_DIR "${OBSCURA_SYSROOT}/include" CACHE PATH "Vulkan's headers")
set(Vulkan_LIBRARY "${OBSCURA_SYSROOT}/lib/libvulkan-1.dll.a" CACHE FILEPATH "Import library of the Vulkan loader")
