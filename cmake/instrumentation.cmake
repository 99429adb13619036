# Builds that watch themselves, each in a folder of its own: scripts/test --sanitize and --coverage, and scripts/fuzz.
option(TISSUE_STIFFNESS_SANITIZE "Stop at wrong memory accesses, leaks and undefined behaviour" OFF)
option(TISSUE_STIFFNESS_SANITIZE_THREAD "Report data races" OFF)
option(TISSUE_STIFFNESS_COVERAGE "Count which lines run" OFF)
option(TISSUE_STIFFNESS_FUZZ "Build the fuzzers of test/fuzz, which clang links" OFF)

# What both need: no program that is not ours loads a sanitizer, and a sanitizer has a malloc of its own.
if(TISSUE_STIFFNESS_SANITIZE OR TISSUE_STIFFNESS_SANITIZE_THREAD)
  set(tissue_stiffness_sanitized TRUE)
endif()

if(tissue_stiffness_sanitized OR TISSUE_STIFFNESS_COVERAGE)
  # Without NDEBUG: Eigen's assertions see a wrong index that still hits memory of the same matrix.
  set(CMAKE_CXX_FLAGS_RELEASE "-O1 -g")
endif()

if(TISSUE_STIFFNESS_SANITIZE)
  # GCC leaves float-cast-overflow out of `undefined`.
  set(sanitizers -fsanitize=address,undefined,float-cast-overflow)
  add_compile_options(${sanitizers} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # GCC's bug 105616: with AddressSanitizer it warns of the standard library's own std::regex.
    add_compile_options(-Wno-maybe-uninitialized)
    # Of the shared libraries only one writes its reports where log_path says.
    add_link_options(-static-libasan -static-libubsan)
  endif()
  add_compile_definitions(_GLIBCXX_ASSERTIONS)
  add_link_options(${sanitizers})
endif()

if(TISSUE_STIFFNESS_SANITIZE_THREAD)
  add_compile_options(-fsanitize=thread -fno-omit-frame-pointer)
  add_link_options(-fsanitize=thread)
  include_directories(BEFORE ${PROJECT_SOURCE_DIR}/cmake/thread_sanitizer)  # what TBB orders
endif()

if(tissue_stiffness_sanitized)
  # Plugins of programs that are not ours: a sanitizer must be loaded first, and these programs do not load it.
  set(CMAKE_DISABLE_FIND_PACKAGE_nodelet TRUE)
  set(CMAKE_DISABLE_FIND_PACKAGE_rviz TRUE)
endif()

if(TISSUE_STIFFNESS_COVERAGE)
  # Threads count too, and what other libraries' headers compute is not our coverage.
  add_compile_options(--coverage -fprofile-update=atomic "-fprofile-filter-files=${PROJECT_SOURCE_DIR}/(src|include)/.*")
  add_link_options(--coverage)
endif()

if(TISSUE_STIFFNESS_FUZZ)
  set(CMAKE_CXX_FLAGS_RELEASE "-O1 -g")
  # Warnings are GCC's business. Signed overflow and the like in other libraries' headers are not ours.
  add_compile_options(-w -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
  set(CMAKE_DISABLE_FIND_PACKAGE_nodelet TRUE)
  set(CMAKE_DISABLE_FIND_PACKAGE_rviz TRUE)
endif()
