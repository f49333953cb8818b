// Linked into every program. A processor that lacks an instruction ends a program without a word, perhaps before
// main(): this runs before anything else that is compiled for more than the oldest x86-64.

#ifdef MINAMO_USES_AVX2

#include <cstdio>
#include <cstdlib>

namespace {

[[gnu::constructor(101)]] void require_processor() {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return;
  std::fputs("minamo: this program is compiled for processors with AVX2 and FMA (x86-64-v3), and this one lacks them; "
             "build it from its sources on this machine\n",
             stderr);
  std::_Exit(2);
}

}  // namespace

#endif
