# Targets `format`, `format_check` and `tidy`.

file(GLOB_RECURSE minamo_formatted CONFIGURE_DEPENDS
  engine/*.hpp engine/*.cpp components/*.hpp components/*.cpp systems/*.hpp systems/*.cpp
  tests/*.hpp tests/*.cpp tools/*.hpp tools/*.cpp)

# The formatter's taste differs from version to version.
find_program(minamo_clang_format NAMES clang-format-14 clang-format)
mark_as_advanced(minamo_clang_format)
if(minamo_clang_format)
  add_custom_target(format COMMAND ${minamo_clang_format} -i ${minamo_formatted}
    COMMENT "Laying out the sources" VERBATIM)
  add_custom_target(format_check COMMAND ${minamo_clang_format} --dry-run --Werror ${minamo_formatted}
    COMMENT "Checking the layout of the sources" VERBATIM)
endif()

# Sources only: the headers come in with them (HeaderFilterRegex in .clang-tidy). What must not compile is left out.
set(minamo_tidied ${minamo_formatted})
list(FILTER minamo_tidied INCLUDE REGEX "\\.cpp$")
list(FILTER minamo_tidied EXCLUDE REGEX "/compile_fail/|/example_")
find_program(minamo_run_clang_tidy NAMES run-clang-tidy-14 run-clang-tidy)
mark_as_advanced(minamo_run_clang_tidy)
if(minamo_run_clang_tidy)
  # run-clang-tidy takes regular expressions; a path with a `+` or brackets in it is no more than a file not found.
  add_custom_target(tidy COMMAND ${minamo_run_clang_tidy} -quiet -p ${PROJECT_BINARY_DIR} ${minamo_tidied}
    COMMENT "Running clang-tidy" VERBATIM)
endif()
