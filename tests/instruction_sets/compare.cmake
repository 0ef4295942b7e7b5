# Runs the driver of every instruction set this processor has and compares what they print.
file(STRINGS /proc/cpuinfo processor_flags REGEX "^flags" LIMIT_COUNT 1)
string(REPLACE " " ";" processor_flags "${processor_flags}")

# steps(program out): the lines a program prints; it must succeed.
function(steps program out)
  execute_process(COMMAND ${MPIEXEC} ${program} OUTPUT_VARIABLE text ERROR_VARIABLE errors
                  RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${program} failed with ${status}:\n${text}${errors}")
  endif()
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

# compare(name program flag...): skips the program when the processor lacks a flag.
function(compare name program)
  foreach(flag IN LISTS ARGN)
    if(NOT flag IN_LIST processor_flags)
      message("${name}: not run, this processor has no ${flag}")
      return()
    endif()
  endforeach()
  steps(${program} found)
  if(NOT found STREQUAL expected)
    message(FATAL_ERROR "${name} gives other bits.\nscalar:\n${expected}\n${name}:\n${found}")
  endif()
  message("${name}: same bits as the scalar program")
endfunction()

steps(${SCALAR} expected)
string(REGEX MATCHALL "step [0-9]+ +[0-9a-f]+\n" hashes "${expected}")
list(LENGTH hashes count)
list(REMOVE_DUPLICATES hashes)
list(LENGTH hashes different)
if(count LESS 30 OR NOT count EQUAL different)
  message(FATAL_ERROR "the scalar program printed ${count} hashes, ${different} of them different; "
                      "30 or more different ones were expected:\n${expected}")
endif()
message("scalar: ${count} hashes\n${expected}")
compare(AVX2 ${AVX2} avx2 fma bmi2 movbe)
compare(AVX-512 ${AVX512} avx512f avx512bw avx512cd avx512dq avx512vl)
