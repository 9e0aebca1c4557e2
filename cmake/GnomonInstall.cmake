# What `cmake --install` lays down: programs, the library, what it finds beside itself (shaders, plugins, modules, the template
# of new-technique), the headers that plugins include, and the package that find_package(Gnomon) reads. Nothing in it names the
# prefix, so that the folder may be moved. Plugins install themselves: gnomon_add_plugin.
include(CMakePackageConfigHelpers)

install(TARGETS gnomon gnomon_headless EXPORT GnomonTargets RUNTIME DESTINATION bin LIBRARY DESTINATION lib)
set_target_properties(gnomon_view PROPERTIES INSTALL_RPATH $ORIGIN/../lib)
install(TARGETS gnomon_view RUNTIME DESTINATION bin)
install(TARGETS gnomon_image LIBRARY DESTINATION lib/gnomon)
install(DIRECTORY framework/gnomon/shaders cmake/template DESTINATION lib/gnomon)
install(DIRECTORY configs/schema DESTINATION lib/gnomon)

install(CODE "set(GNOMON_SOURCE \"${PROJECT_SOURCE_DIR}/framework\")")
install(SCRIPT cmake/install_headers.cmake)
install(FILES ${PROJECT_BINARY_DIR}/generated/gnomon/abi_tag.h DESTINATION include/gnomon)

set(package lib/cmake/Gnomon)
install(EXPORT GnomonTargets NAMESPACE Gnomon:: DESTINATION ${package})
configure_package_config_file(cmake/GnomonConfig.cmake.in ${PROJECT_BINARY_DIR}/generated/GnomonConfig.cmake
                              INSTALL_DESTINATION ${package})
# Below 1.0 every minor version may change the contract.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/generated/GnomonConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/generated/GnomonConfig.cmake ${PROJECT_BINARY_DIR}/generated/GnomonConfigVersion.cmake
              cmake/GnomonPlugin.cmake DESTINATION ${package})
