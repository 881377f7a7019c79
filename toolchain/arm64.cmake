# SPDX-License-Identifier: MIT
# For arm64, with Debian's cross compiler and a sysroot that toolchain/sysroot.sh makes (DYNSLAM_SYSROOT). Without
# DYNSLAM_CPU the program runs on every 64-bit Pi, tuned for the slowest.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES DYNSLAM_SYSROOT DYNSLAM_CPU)

# A Pi 3 has CRC instructions and no cryptographic ones.
if(DYNSLAM_CPU AND NOT DYNSLAM_CPU STREQUAL "a53")
  set(CMAKE_CXX_FLAGS_INIT "-mcpu=cortex-${DYNSLAM_CPU}+nocrypto")
else()
  set(CMAKE_CXX_FLAGS_INIT "-march=armv8-a+crc -mtune=cortex-a53")
endif()

set(CMAKE_SYSROOT "${DYNSLAM_SYSROOT}")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_SYSROOT_DIR} "${CMAKE_SYSROOT}")
set(ENV{PKG_CONFIG_LIBDIR} "${CMAKE_SYSROOT}/usr/lib/aarch64-linux-gnu/pkgconfig:${CMAKE_SYSROOT}/usr/share/pkgconfig")

# Tests run under emulation.
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static -L "${CMAKE_SYSROOT}")
