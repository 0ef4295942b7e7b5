# cmake --install build/release [--prefix DIR]: program, tools, scenes, completion, and the libraries
# as a CMake package; cpack -G DEB makes a Debian package of them.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# Libraries outside the system's own folders, as on a cluster, are found where they were linked.
set_target_properties(poreshock PROPERTIES INSTALL_RPATH_USE_LINK_PATH TRUE)
install(TARGETS poreshock RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY include/poreshock DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY input DESTINATION ${CMAKE_INSTALL_DATADIR}/poreshock)
install(DIRECTORY tools/poreshock_report DESTINATION ${CMAKE_INSTALL_DATADIR}/poreshock/tools
        PATTERN __pycache__ EXCLUDE)
install(PROGRAMS tools/report.py tools/plate_exact.py tools/plate_release.py tools/hugoniot.py
        tools/paraview_view.py
        DESTINATION ${CMAKE_INSTALL_DATADIR}/poreshock/tools)
# The pages in their folders, so that their links lead on.
foreach(page README.md input/README.md input/first_hour/README.md src/README.md src/physics/README.md
        src/morphology/README.md src/output/README.md include/poreshock/README.md tests/README.md
        tests/verification/README.md tests/benchmark/README.md tools/README.md tools/CHANGELOG.md jobscripts/README.md
        tests/verification.md tests/hard_cases.md tests/faults.md tests/readme/porous_aluminium.png)
  get_filename_component(folder ${page} DIRECTORY)
  install(FILES ${page} DESTINATION ${CMAKE_INSTALL_DOCDIR}/${folder})
endforeach()
install(FILES tools/completion.bash
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME poreshock)

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/poreshock)
set(layers core files image material scene particles grid morphology output sample transfer physics solver run)
list(TRANSFORM layers PREPEND poreshock_)
foreach(target IN LISTS layers)
  string(REPLACE "poreshock_" "" name ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
endforeach()
install(TARGETS ${layers} poreshock_flags poreshock_eigen poreshock_toml poreshock_metis
                poreshock_hdf5 poreshock_mpi
        EXPORT poreshockTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/poreshock)
install(EXPORT poreshockTargets NAMESPACE poreshock:: DESTINATION ${package})
configure_package_config_file(tools/cmake/poreshockConfig.cmake.in
  ${PROJECT_BINARY_DIR}/poreshockConfig.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/poreshockConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/poreshockConfig.cmake
              ${PROJECT_BINARY_DIR}/poreshockConfigVersion.cmake DESTINATION ${package})

# A package for other machines than this one is built with -DPORESHOCK_ARCHITECTURE=x86-64-v3.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR poreshock)
set(CPACK_PACKAGE_CONTACT "the authors of poreshock <poreshock@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS openmpi-bin)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-h5py, python3-numpy, python3-matplotlib")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
    "libopenmpi-dev, petsc-dev, libhdf5-openmpi-dev, libmetis-dev, libeigen3-dev, libpng-dev, libtiff-dev, zlib1g-dev, paraview")
include(CPack)
