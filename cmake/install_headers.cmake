# Installs gnomon/plugin.h with every header of ours that it reaches, and no other: what plugins cannot see can change freely.
# Runs while installing, when the headers are those that were built. GNOMON_SOURCE: the folder they are included from.
cmake_policy(VERSION 3.25)  # install scripts begin with the oldest
set(queue gnomon/plugin.h)
set(seen gnomon/abi_tag.h)  # generated
while(queue)
  list(POP_FRONT queue header)
  if(header IN_LIST seen)
    continue()
  endif()
  list(APPEND seen ${header})
  get_filename_component(folder ${header} DIRECTORY)
  file(INSTALL "${GNOMON_SOURCE}/${header}" DESTINATION "${CMAKE_INSTALL_PREFIX}/include/${folder}")
  file(STRINGS "${GNOMON_SOURCE}/${header}" includes REGEX "^[ \t]*#[ \t]*include[ \t]*[<\"]gnomon/")
  foreach(line IN LISTS includes)
    string(REGEX REPLACE ".*[<\"](gnomon/[^>\"]+)[>\"].*" "\\1" included "${line}")
    list(APPEND queue ${included})
  endforeach()
endwhile()
