# rmac_discover_suites(TARGET LOCK): a ctest for each suite of an executable of GoogleTest's, `motion.Sweep` for one of test_motion. As
# gtest_discover_tests, which has one for each test; where a process takes long to start, as under the sanitizers, that costs more than most
# tests do.
if(NOT CMAKE_SCRIPT_MODE_FILE)
  set(RMAC_SUITES_SCRIPT ${CMAKE_CURRENT_LIST_FILE})
  function(rmac_discover_suites target lock)
    set(file ${CMAKE_CURRENT_BINARY_DIR}/${target}_suites.cmake)
    if(NOT EXISTS ${file})
      file(WRITE ${file} "add_test(${target}_NOT_BUILT ${target}_NOT_BUILT)\n")
    endif()
    add_custom_command(TARGET ${target} POST_BUILD BYPRODUCTS ${file} VERBATIM
      COMMAND ${CMAKE_COMMAND} -D EXECUTABLE=$<TARGET_FILE:${target}> -D LOCK=${lock} -D FILE=${file} -P ${RMAC_SUITES_SCRIPT})
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${file})
  endfunction()
  return()
endif()

execute_process(COMMAND ${EXECUTABLE} --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
cmake_path(GET EXECUTABLE STEM name)
string(REGEX REPLACE "^test_" "" name ${name})
string(REGEX MATCHALL "(^|\n)[A-Za-z][^\n]*\\.( |\n)" suites "${listed}")  # its tests are indented, and a suite's type follows its name
set(script)
foreach(suite ${suites})
  string(REGEX REPLACE "[\n .]" "" suite "${suite}")
  string(APPEND script "add_test(${name}.${suite} ${EXECUTABLE} --gtest_brief=1 --gtest_filter=${suite}.*)\n"
    "set_tests_properties(${name}.${suite} PROPERTIES LABELS unit TIMEOUT 900 RESOURCE_LOCK \"${LOCK}\")\n")
endforeach()
file(WRITE ${FILE} "${script}")
