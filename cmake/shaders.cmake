# probebench_embed_shaders(TARGET shader...): each shader, its includes expanded, becomes generated/<path>.h with
#   inline constexpr char k<Name>[] = ...;   in namespace pb::shaders
# and is compiled by glslangValidator as part of the build. Stages by extension: .vert .frag .comp.
find_program(GLSLANG_VALIDATOR glslangValidator REQUIRED)
find_package(Python3 REQUIRED COMPONENTS Interpreter)

function(probebench_embed_shaders target)
  foreach(shader ${ARGN})
    set(source ${CMAKE_SOURCE_DIR}/${shader})
    set(header ${CMAKE_BINARY_DIR}/generated/${shader}.h)
    set(expanded ${CMAKE_BINARY_DIR}/generated/${shader})
    add_custom_command(
      OUTPUT ${header}
      COMMAND Python3::Interpreter ${CMAKE_SOURCE_DIR}/cmake/embed_shader.py ${CMAKE_SOURCE_DIR} ${shader} ${expanded} ${header}
      COMMAND ${GLSLANG_VALIDATOR} --quiet ${expanded}
      DEPENDS ${source} ${CMAKE_SOURCE_DIR}/cmake/embed_shader.py
      DEPFILE ${header}.d
      COMMENT "Shader ${shader}"
      VERBATIM)
    target_sources(${target} PRIVATE ${header})
  endforeach()
endfunction()
