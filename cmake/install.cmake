# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
# The library alone: headers, archive, CMake package, licence. The command is installed when it was built.
include(CMakePackageConfigHelpers)
set(vsplit_package ${CMAKE_INSTALL_LIBDIR}/cmake/vsplit)
install(TARGETS vsplit EXPORT vsplit-targets)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/lib/include/vsplit DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT vsplit-targets NAMESPACE vsplit:: DESTINATION ${vsplit_package})
# What a static archive needs when a stranger links it, and nothing of the baker.
if(VSPLIT_WITH_DRACO)
  set(vsplit_find_draco "find_dependency(draco CONFIG)\n")
  set(vsplit_link_draco "-ldraco ")
endif()
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/vsplit-config.cmake @ONLY CONTENT
"include(CMakeFindDependencyMacro)
@vsplit_find_draco@include(\${CMAKE_CURRENT_LIST_DIR}/vsplit-targets.cmake)
")
write_basic_package_version_file(${PROJECT_BINARY_DIR}/vsplit-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/vsplit-config.cmake ${PROJECT_BINARY_DIR}/vsplit-config-version.cmake
        DESTINATION ${vsplit_package})
# And for builds without CMake; paths follow the file, so that the prefix may move.
file(RELATIVE_PATH vsplit_up /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/vsplit.pc @ONLY CONTENT
"prefix=\${pcfiledir}/@vsplit_up@
Name: vsplit
Description: @PROJECT_DESCRIPTION@
Version: @PROJECT_VERSION@
Cflags: -I\${prefix}/@CMAKE_INSTALL_INCLUDEDIR@
Libs: -L\${prefix}/@CMAKE_INSTALL_LIBDIR@ -lvsplit
Libs.private: @vsplit_link_draco@-lstdc++ -lm
")
install(FILES ${PROJECT_BINARY_DIR}/vsplit.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSES/MIT.txt DESTINATION ${CMAKE_INSTALL_DOCDIR})
if(TARGET vsplit_command)
  install(TARGETS vsplit_command)
  if(VSPLIT_WITH_CGAL)
    install(FILES ${PROJECT_SOURCE_DIR}/LICENSES/GPL-3.0-or-later.txt DESTINATION ${CMAKE_INSTALL_DOCDIR})
  endif()
endif()
