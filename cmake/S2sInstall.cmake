# Install rules of the libraries and the CMake package, so that find_package(SeabedToSky) gives s2s::<name>.

include(CMakePackageConfigHelpers)

get_property(targets GLOBAL PROPERTY S2S_INSTALL_TARGETS)
set_target_properties(s2s_flags PROPERTIES EXPORT_NAME flags)
install(TARGETS ${targets} s2s_flags EXPORT SeabedToSkyTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT SeabedToSkyTargets NAMESPACE s2s:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/SeabedToSky)
configure_package_config_file(cmake/SeabedToSkyConfig.cmake.in ${CMAKE_BINARY_DIR}/SeabedToSkyConfig.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/SeabedToSky)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/SeabedToSkyConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/SeabedToSkyConfig.cmake ${CMAKE_BINARY_DIR}/SeabedToSkyConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/SeabedToSky)
install(DIRECTORY ini DESTINATION ${CMAKE_INSTALL_DATADIR}/seabed-to-sky)
install(DIRECTORY share/scenes share/docs DESTINATION ${CMAKE_INSTALL_DATADIR}/seabed-to-sky)
