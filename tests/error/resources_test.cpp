// Disks that are full, folders that may not be written, memory that ends, readers that go away: one message, exit 3 (2
// where nothing was run), and what was there before is still there.

#include "support/build.hpp"
#include "support/folder.hpp"
#include "support/program_output.hpp"
#include "support/xml.hpp"

#include "engine/storage/hdf5.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace minamo;

namespace {

using Arguments = std::vector<std::string>;

/// A dam break of 200 particles with many frames.
Arguments run_to(const std::string& out, const Arguments& more = {}) {
  Arguments arguments{"run",
                      std::string(MINAMO_SOURCE_DIR) + "/scenes/paper/dam_break_tpic.json",
                      "--out",
                      out,
                      "--threads",
                      "1",
                      "--quiet",
                      "--set",
                      "/grid/cells=[20, 20]",
                      "--set",
                      "/output/every=0.002",
                      "--set",
                      "/time/end=0.06"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

/// Frames that can be read.
int whole_frames(const std::string& path) {
  const Hdf5File file(path, Hdf5File::Access::read);
  int count = 0;
  while (file.has("/particles/" + std::to_string(count))) {
    if (file.read_bytes("/particles/" + std::to_string(count) + "/velocity").empty()) return -1;
    ++count;
  }
  return count;
}

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// What must come out byte for byte the same.
const Arguments output{"history.csv", "fields.h5", "fields.xdmf"};

bool ends_with_a_whole_row(const std::string& history) {
  const std::string text = text_of(history);
  const auto last = text.find_last_of('\n', text.size() - 2);
  const std::string row = text.substr(last + 1);
  return text.back() == '\n' && std::count(row.begin(), row.end(), ',') == 13;
}

}  // namespace

TEST_CASE("a run whose files may not grow ends with 3, whole files, and goes on when they may", "[error]") {
  const Folder folder;
  // Blocks of 512 or 1024 bytes, as the shell has it; fields.h5 ends up with 540 kB.
  const std::string blocks = GENERATE("110", "170");
  const auto end = output_of_program(folder / "", run_to("out"), "ulimit -f " + blocks + " && ");
  CHECK(end.code == 3);
  CHECK_THAT(end.err, Catch::Contains("out/fields.h5: cannot be written: file too large") &&
                          Catch::Contains("the last good checkpoint is out/checkpoint.h5, of t = 0.0") &&
                          Catch::Contains("; --resume goes on from there"));
  CHECK(lines(end.err) <= 3);
  CHECK(whole_frames(folder / "out/fields.h5") > 2);
  CHECK(is_well_formed(text_of(folder / "out/fields.xdmf")));
  CHECK(ends_with_a_whole_row(folder / "out/history.csv"));
  CHECK(output_of_program(folder / "", run_to("out", {"--resume"})).code == 0);
  CHECK(output_of_program(folder / "", run_to("whole")).code == 0);
  CHECK(differing_files(folder / "out", folder / "whole", output).empty());
}

TEST_CASE("a run on a full disk ends with 3, whole files, and goes on when there is room", "[error]") {
  const auto [size, checkpoint, kept] = GENERATE(table<std::string, std::string, std::string>(
      {{"150k", "1", "there is no checkpoint after t = 0 s: the run starts anew"},
       {"250k", "0.01", "checkpoint.h5, of t = 0.01 s after 10 steps (the run came to t = 0.0"}}));
  const Folder folder;
  std::filesystem::create_directory(folder / "disk");
  // A disk of the program's own, where one may be mounted.
  const std::string make = "mount -t tmpfs -o size=" + size + " none " + (folder / "disk");
  const std::string in_own_namespace = "unshare --mount --map-root-user sh -c '" + make + "' 2> /dev/null";
  if (std::system(in_own_namespace.c_str()) != 0) {
    WARN("no disk may be mounted here");
    return;
  }
  const std::string program = program_path();
  std::string line;
  for (const std::string& word : run_to(folder / "disk/out", {"--set", "/output/checkpoint=" + checkpoint}))
    line += " \"" + word + "\"";
  const std::string script = make + " || exit 9\n\"" + program + "\"" + line + " > \"" + (folder / "log") +
                             "\" 2>&1; echo $? >> \"" + (folder / "log") + "\"\ncp \"" +
                             (folder / "disk/out/fields.h5") + "\" \"" + (folder / "full.h5") +
                             "\"\nmount -o remount,size=10M " + (folder / "disk") + "\n\"" + program + "\"" + line +
                             " --resume; echo $? >> \"" + (folder / "log") + "\"\ncp -r " + (folder / "disk/out") +
                             " " + (folder / "out") + "\n";
  std::ofstream(folder / "script") << script;
  REQUIRE(std::system(("unshare --mount --map-root-user sh " + (folder / "script")).c_str()) == 0);
  CHECK_THAT(text_of(folder / "log"), Catch::Contains("cannot be written: no space left on device") &&
                                          Catch::Contains(kept) && Catch::EndsWith("\n3\n0\n"));
  CHECK(whole_frames(folder / "full.h5") > 2);
  CHECK(output_of_program(folder / "", run_to("whole", {"--set", "/output/checkpoint=" + checkpoint})).code == 0);
  CHECK(differing_files(folder / "out", folder / "whole", output).empty());
}

TEST_CASE("a run into a folder that may not be written is refused with 2", "[error]") {
  const Folder folder;
  std::filesystem::create_directory(folder / "out");
  std::filesystem::permissions(folder / "out", std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  std::filesystem::permissions(folder / "", std::filesystem::perms::all);
  // Root may write everywhere.
  const std::string as_nobody = geteuid() == 0 ? "chown nobody out && exec setpriv --reuid nobody --clear-groups " : "";
  const std::string out = GENERATE("out", "/proc/minamo", "/dev/null");
  const auto end = output_of_program(folder / "", run_to(out), as_nobody);
  CHECK(end.code == 2);
  CHECK_THAT(end.err, Catch::Contains("expected  a folder for the results (--out)"));
}

TEST_CASE("a reader that goes away, as with `| head`, ends the program without a word", "[error]") {
  const Folder folder;
  const Arguments arguments = GENERATE(Arguments{"list", "systems"}, Arguments{"schema"}, Arguments{"--help"});
  CAPTURE(arguments);
  // The reader is gone before the program begins.
  std::string line = "cd " + (folder / "") + " && { sleep 0.2; '" + program_path() + "'";
  for (const std::string& argument : arguments) line += " " + argument;
  REQUIRE(std::system((line + " 2> err; echo $? > code; } | true").c_str()) == 0);
  CHECK(text_of(folder / "code") == "0\n");
  CHECK(text_of(folder / "err").empty());
}

TEST_CASE("a full disk behind stdout is one message and 3", "[error]") {
  const Folder folder;
  Arguments arguments = GENERATE(Arguments{"list", "systems"}, run_to("out", {"--steps", "2", "--profile"}));
  std::erase(arguments, "--quiet");
  std::string line = "cd " + (folder / "") + " && '" + program_path() + "'";
  for (const std::string& argument : arguments) line += " '" + argument + "'";
  CHECK(WEXITSTATUS(std::system((line + " > /dev/full 2> err").c_str())) == 3);
  CHECK_THAT(text_of(folder / "err"), Catch::Contains("stdout: cannot be written"));
}

TEST_CASE("a run that has too little memory is refused, or ends with 3 and a message, and never crashes", "[error]") {
  if (is_address_sanitized()) return;  // which needs more address space than any limit leaves
  const Folder folder;
  const std::string solver = GENERATE("block", "umfpack");
  const Arguments large = run_to("out", {"--set", "/grid/cells=[100, 100]", "--set", "/particles/0/per_cell=4", "--set",
                                         R"(/solver={"scheme": ")" + solver + R"("})", "--steps", "3", "--overwrite"});
  int refused = 0;
  int last = -1;
  // From too little for the program itself to enough for the run. BLAS waited for ever for the address space it wants.
  for (int kilobytes = 90'000; kilobytes <= 500'000; kilobytes += 20'000) {
    const auto end = output_of_program(folder / "", large,
                                       "ulimit -v " + std::to_string(kilobytes) + " && timeout --signal KILL 60 ");
    CAPTURE(kilobytes, end.err);
    const bool said = !end.err.empty();
    REQUIRE((end.code == 0 || (said && (end.code == 2 || end.code == 3 || end.code == 127))));
    last = end.code;
    refused += end.code == 2 || end.code == 3 ? 1 : 0;
  }
  CHECK(refused > 0);
  CHECK(last == 0);
}
