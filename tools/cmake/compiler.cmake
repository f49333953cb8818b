# How our own code is compiled. Nothing here changes what a floating-point expression means (no -ffast-math),
# but for two sources below.

find_program(minamo_ccache ccache)
mark_as_advanced(minamo_ccache)
if(minamo_ccache AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${minamo_ccache})
endif()

# Options that code which includes our headers must share.
# Contraction off: an expression rounds in the same way wherever it is inlined, and a*b - c*d is zero where the products
# are equal. It costs 2 % of a gather kernel in 2-D and nothing in 3-D (g++ 12, Zen 4).
# The processor: with other instructions Eigen lays out and frees memory differently. AVX-512 is left out: with it the
# same kernel was as fast in 2-D and 20 % slower in 3-D, and g++ 12 warns of Eigen's use of it. What is left of an
# x86-64 is x86-64-v3: a program for that is as fast as one for the machine that compiles it.
set(minamo_public_options -ffp-contract=off)
if(MINAMO_PROCESSOR)
  list(APPEND minamo_public_options -march=${MINAMO_PROCESSOR})
  if(MINAMO_PROCESSOR STREQUAL "native" AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    list(APPEND minamo_public_options -mno-avx512f)
  endif()
endif()

# Says at the start of a program what its processor lacks. It runs on any x86-64 itself.
set(minamo_processor_check ${PROJECT_SOURCE_DIR}/tools/program/processor_check.cpp)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  include(CheckCXXSourceCompiles)
  set(CMAKE_REQUIRED_FLAGS "-march=${MINAMO_PROCESSOR}")
  check_cxx_source_compiles("#if !defined __AVX2__ || !defined __FMA__\n#error\n#endif\nint main() {}" minamo_uses_avx2_${MINAMO_PROCESSOR})
  unset(CMAKE_REQUIRED_FLAGS)
  set_source_files_properties(${minamo_processor_check} PROPERTIES COMPILE_OPTIONS -march=x86-64
    COMPILE_DEFINITIONS "$<$<BOOL:${minamo_uses_avx2_${MINAMO_PROCESSOR}}>:MINAMO_USES_AVX2>")
endif()

# Nobody reads errno after sqrt; without it the call becomes one instruction.
set(minamo_private_options -fno-math-errno)

# Its roundings are corrected by an iteration, and its speed is that of fused multiply-add.
set_source_files_properties(systems/linear/envelope_lu.cpp PROPERTIES COMPILE_OPTIONS -ffp-contract=fast
  SKIP_PRECOMPILE_HEADERS ON)
# Likewise: 12 800 rows within 80 of the diagonal take 2.5 ms with it, 3.0 ms without.
set_source_files_properties(systems/linear/envelope_cholesky.cpp PROPERTIES COMPILE_OPTIONS -ffp-contract=fast
  SKIP_PRECOMPILE_HEADERS ON)

# minamo_compile_options(TARGET [SANITIZER]): without one that of MINAMO_SANITIZE.
function(minamo_compile_options target)
  set(sanitizer ${MINAMO_SANITIZE})
  if(ARGC GREATER 1)
    set(sanitizer ${ARGV1})
  endif()
  target_compile_options(${target} PUBLIC ${minamo_public_options})
  target_compile_options(${target} PRIVATE ${minamo_private_options})
  if(NOT sanitizer)
    # With -Wconversion clang looks at signs, too.
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion -Wshadow
      $<$<BOOL:${MINAMO_DEVELOPER}>:-Werror>)
  else()
    # No warnings here: the sanitizers' own code sets off false ones, sources compiled together others, and the ordinary
    # build has looked already.
    target_compile_options(${target} PRIVATE -w)
    if(sanitizer STREQUAL "thread")
      set(sanitize -fsanitize=thread)
    else()
      # vptr would look for type information that the packaged TBB does not export. Null pointers and places outside of
      # objects are the address sanitizer's matter, too, and doubles may lie anywhere: without these checks and with -O2
      # the tests take half of the time.
      set(sanitize -fsanitize=address,undefined -fno-sanitize=vptr,null,alignment,object-size,pointer-overflow)
      target_compile_options(${target} PRIVATE -fno-sanitize-recover=undefined)
      target_compile_definitions(${target} PRIVATE _GLIBCXX_ASSERTIONS)
    endif()
    if(MINAMO_FUZZ)
      # What libFuzzer steers by; and conversions of numbers that do not fit, of which g++ knows nothing.
      list(APPEND sanitize -fsanitize=fuzzer-no-link,float-cast-overflow)
    endif()
    # With assertions, our own and Eigen's. -g1: lines for the reports, a quarter less time to compile. -O1: a fifth less
    # than -O2, and the tests take a tenth longer.
    target_compile_options(${target} PRIVATE ${sanitize} -O1 -g1 -fno-omit-frame-pointer -UNDEBUG)
    target_link_options(${target} PUBLIC ${sanitize})
  endif()
endfunction()

# Has the headers after `target` read once for all of its sources, which saves 1 to 2 s for each of them (g++ 12). Not
# with a launcher like ccache, which would not know what it has compiled before.
function(minamo_read_once target)
  if(NOT CMAKE_CXX_COMPILER_LAUNCHER)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# Has the sources after `group` compiled `size` at a time, for those whose headers take most of the time: half of it is
# saved. Their helpers need names of their own within their group.
function(minamo_compile_together group size)
  set(number 0)
  foreach(source IN LISTS ARGN)
    math(EXPR part "${number} / ${size}")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group}_${part})
    math(EXPR number "${number} + 1")
  endforeach()
endfunction()
