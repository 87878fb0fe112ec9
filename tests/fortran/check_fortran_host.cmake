# Runs the example host and compares its tables with closed forms.
#   cmake -D PROGRAM=<fortran_host> -P check_fortran_host.cmake
execute_process(COMMAND ${PROGRAM} OUTPUT_VARIABLE output RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "the program ended with ${result}\n${output}")
endif()

# Reversal points: strain 11, stress 11, ..., EQPS. Closed forms: 420/1.01, then |stress| grows by 2000 d(EQPS) with
# d(EQPS) = (200000*0.02 - 2 |stress|)/202000 in each leg. The printed digits round the last one.
foreach(row
    " 20      0.010000    415\\.84158[34] +-?[0-9.]+    0\\.00792079 "
    " 40     -0.010000   -447\\.21105[78] +-?[0-9.]+    0\\.02360553 "
    " 60      0.010000    477\\.95935[34] +-?[0-9.]+    0\\.03897968 ")
  if(NOT output MATCHES "${row}")
    message(FATAL_ERROR "no line matches '${row}' in\n${output}")
  endif()
endforeach()

# Shear of 0.002: elastic, G*0.002 = 153.846154. Shear of 0.016: EQPS = (sqrt(3)*G*0.016 - 400)/(3G + 2000),
# stress = (400 + 2000 EQPS)/sqrt(3).
foreach(row " 1      0.002000    153\\.84615[34]    0\\.00000000" " 8      0.016000    239\\.53084[01]    0\\.00743979")
  if(NOT output MATCHES "${row}")
    message(FATAL_ERROR "no line matches '${row}' in\n${output}")
  endif()
endforeach()
message(STATUS "all rows agree with the closed forms")
