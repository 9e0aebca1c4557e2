# gnomon_add_plugin(NAME SOURCES a.cpp ... [LINK library ...])
#
# Builds NAME.so and lays it beside its JSON and its shaders in the installation's plugins/NAME folder.
# NAME.json and every *.vert *.frag *.comp *.geom *.glsl of the calling folder go with it.
function(gnomon_add_plugin name)
  cmake_parse_arguments(PLUGIN "" "DIRECTORY" "SOURCES;LINK" ${ARGN})
  if(NOT PLUGIN_DIRECTORY)
    set(PLUGIN_DIRECTORY ${GNOMON_HOME}/plugins/${name})
    set_property(GLOBAL APPEND PROPERTY GNOMON_PLUGINS ${name})  # those of the installation, for who needs them built
  endif()
  add_library(${name} MODULE ${PLUGIN_SOURCES})
  gnomon_compile_options(${name})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # Two versions of a plugin may be loaded at once: none of its statics may be made unique in the process.
    target_compile_options(${name} PRIVATE -fno-gnu-unique)
  endif()
  target_link_libraries(${name} PRIVATE gnomon ${PLUGIN_LINK})
  set_target_properties(${name} PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
                                           LIBRARY_OUTPUT_DIRECTORY ${PLUGIN_DIRECTORY})
  file(GLOB data CONFIGURE_DEPENDS *.json *.vert *.frag *.comp *.geom *.glsl)
  gnomon_copy_files(${name}_data ${PLUGIN_DIRECTORY} ${CMAKE_CURRENT_SOURCE_DIR} ${data})
  add_dependencies(${name} ${name}_data)
endfunction()

# gnomon_copy_files(TARGET DESTINATION BASE FILES...): copies files, keeping their paths below BASE, when they change.
function(gnomon_copy_files target destination base)
  set(copies)
  foreach(file ${ARGN})
    file(RELATIVE_PATH relative ${base} ${file})
    set(copy ${destination}/${relative})
    add_custom_command(OUTPUT ${copy} COMMAND ${CMAKE_COMMAND} -E copy ${file} ${copy} DEPENDS ${file} VERBATIM)
    list(APPEND copies ${copy})
  endforeach()
  add_custom_target(${target} ALL DEPENDS ${copies})
endfunction()
