# Runs the fuzzer for SECONDS on CORPUS, with SOURCE seeded with the small models of the content folder.
set(content $ENV{OBSCURA_CONTENT})
if(NOT content)
  set(content ${SOURCE}/../shared/content)
endif()
file(MAKE_DIRECTORY ${CORPUS} ${CORPUS}.seeds)
set(seeds)
if(SOURCE)
  file(GLOB_RECURSE seeds ${content}/conformance/*.gltf ${content}/conformance/*.glb ${content}/invalid/*.gltf ${content}/invalid/*.glb)
endif()
set(number 0)
foreach(seed ${seeds})
  file(SIZE ${seed} size)
  if(size LESS 65536)
    file(COPY_FILE ${seed} ${CORPUS}.seeds/${number} ONLY_IF_DIFFERENT)
    math(EXPR number "${number} + 1")
  endif()
endforeach()
# The timeout in seconds finds endless loops. Draco may need seconds for a damaged stream, much longer instrumented on a loaded machine.
execute_process(
  COMMAND ${FUZZER} -max_total_time=${SECONDS} -timeout=120 -rss_limit_mb=1024 -max_len=65536 -print_final_stats=1
          -artifact_prefix=${CORPUS}/../ ${CORPUS} ${CORPUS}.seeds
  RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "the fuzzer found a fault: ${result}; its input lies in ${CORPUS}/..")
endif()
