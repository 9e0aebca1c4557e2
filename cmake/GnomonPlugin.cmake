# gnomon_add_plugin(NAME SOURCES a.cpp ... [LINK library ...] [DIRECTORY folder])
#
# Builds NAME.so and lays it beside its JSON and its shaders in a folder of its own: the build tree's plugins/NAME, or DIRECTORY.
# NAME.json and every *.vert *.frag *.comp *.geom *.glsl of the calling folder go with it. `cmake --install` puts the same
# folder where an installed Gnomon looks for plugins; those with a DIRECTORY are not installed.
#
# Part of the framework's build and of the installed package: there find_package(Gnomon) gives it.
function(gnomon_add_plugin name)
  cmake_parse_arguments(PLUGIN "" "DIRECTORY" "SOURCES;LINK" ${ARGN})
  add_library(${name} MODULE ${PLUGIN_SOURCES})
  if(COMMAND gnomon_compile_options)
    gnomon_compile_options(${name})
  elseif(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    target_compile_options(${name} PRIVATE -O2)  # what will be timed is optimised, unless its author chose otherwise
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # Two versions of a plugin may be loaded at once: none of its statics may be made unique in the process.
    target_compile_options(${name} PRIVATE -fno-gnu-unique)
  endif()
  target_link_libraries(${name} PRIVATE Gnomon::gnomon ${PLUGIN_LINK})
  file(GLOB data CONFIGURE_DEPENDS *.json *.vert *.frag *.comp *.geom *.glsl)
  if(NOT PLUGIN_DIRECTORY)
    if(GNOMON_HOME)
      set(PLUGIN_DIRECTORY ${GNOMON_HOME}/plugins/${name})
      set_property(GLOBAL APPEND PROPERTY GNOMON_PLUGINS ${name})  # those of the installation, for who needs them built
    else()
      set(PLUGIN_DIRECTORY ${PROJECT_BINARY_DIR}/plugins/${name})
    endif()
    install(TARGETS ${name} LIBRARY DESTINATION lib/gnomon/plugins/${name})
    install(FILES ${data} DESTINATION lib/gnomon/plugins/${name})
  endif()
  set_target_properties(${name} PROPERTIES
    PREFIX "" CXX_EXTENSIONS OFF CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    LIBRARY_OUTPUT_DIRECTORY ${PLUGIN_DIRECTORY} INSTALL_RPATH $ORIGIN/../../..)
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
