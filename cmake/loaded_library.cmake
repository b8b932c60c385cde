# probebench_loaded_library(SONAME LIBRARY): for a library that is loaded at run time and not linked, the name that linking it
# would have recorded; where its folder isn't one of the linker's own, programs look there too, as if they were linked with it.
function(probebench_loaded_library soname library)
  execute_process(COMMAND ${CMAKE_READELF} -d ${library} OUTPUT_VARIABLE dynamic_section COMMAND_ERROR_IS_FATAL ANY)
  if(NOT dynamic_section MATCHES "SONAME[^[]*\\[([^]]+)\\]")
    message(FATAL_ERROR "a shared library with a soname is wanted, '${library}' has none")
  endif()
  set(${soname} ${CMAKE_MATCH_1} PARENT_SCOPE)
  cmake_path(GET library PARENT_PATH folder)
  if(NOT folder IN_LIST CMAKE_CXX_IMPLICIT_LINK_DIRECTORIES)
    set(CMAKE_INSTALL_RPATH ${CMAKE_INSTALL_RPATH} ${folder} PARENT_SCOPE)
  endif()
endfunction()
