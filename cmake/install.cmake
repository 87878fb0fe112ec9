# What a user gets: the shared libraries under Lode's and Abaqus' names, the headers of the models, the Fortran interface
# module, the program, and `find_package(lode)` with lode::core and lode::umat.
include(CMakePackageConfigHelpers)

install(DIRECTORY core/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lode FILES_MATCHING PATTERN "*.h" PATTERN "*.hpp")
install(FILES fortran_shims/lode_interfaces.f90 DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lode)
install(TARGETS lode_record LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS lode_core lode_umat lode_umat_sp EXPORT lodeTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
foreach(link libstandardU libexplicitU-D)
  install(CODE "file(CREATE_LINK liblode.so \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/${link}.so\" SYMBOLIC)")
endforeach()
install(CODE "file(CREATE_LINK liblode-sp.so \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/libexplicitU.so\" SYMBOLIC)")
if(TARGET lode)
  install(TARGETS lode RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/lode)
install(EXPORT lodeTargets NAMESPACE lode:: DESTINATION ${package_dir})
configure_package_config_file(cmake/lode-config.cmake.in ${PROJECT_BINARY_DIR}/lode-config.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lode-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lode-config.cmake ${PROJECT_BINARY_DIR}/lode-config-version.cmake
  DESTINATION ${package_dir})
