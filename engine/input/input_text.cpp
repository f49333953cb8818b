#include "engine/input/input_text.hpp"

#include "engine/input/text_mistakes.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>

namespace minamo {

namespace {

/// Where the character before `position` stands, in the count of an editor.
std::string line_and_column(const std::string& text, std::size_t position) {
  const std::string before = text.substr(0, position > 0 ? position - 1 : 0);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const auto column = before.size() - (before.rfind('\n') + 1) + 1;  // npos + 1 is 0
  return fmt::format("line {}, column {}", line, column);
}

std::string trimmed_line(const std::string& text, std::size_t position) {
  if (position > text.size()) return {};
  const auto newline_before = position > 1 ? text.rfind('\n', position - 2) : std::string::npos;
  std::string line = text.substr(newline_before + 1, text.find('\n', position - 1) - newline_before - 1);
  line.erase(0, line.find_first_not_of(" \t"));
  return line.size() <= 60 ? line : std::string();
}

/// Follows the parser through a text: notes keys given twice, which it would let pass, and the place where it fails.
class TextCheck : public nlohmann::json_sax<Json> {
 public:
  TextCheck(const std::string& text, const std::string& file) : text_(text), file_(file) {}

  const std::vector<Problem>& problems() const { return problems_; }

  bool null() override { return next(); }
  bool boolean(bool) override { return next(); }
  bool number_integer(number_integer_t) override { return next(); }
  bool number_unsigned(number_unsigned_t) override { return next(); }
  bool number_float(number_float_t, const string_t&) override { return next(); }
  bool string(string_t&) override { return next(); }
  bool binary(binary_t&) override { return next(); }
  bool start_object(std::size_t) override { return open(Level{}); }
  bool start_array(std::size_t) override { return open(Level{.index = 0}); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    levels_.back().key = name;
    constexpr std::size_t most = 1000;  // a key is found by looking at all of them
    if (levels_.back().names.size() == most)
      return refuse("too many keys", fmt::format("at most {} of an object", most));
    if (!levels_.back().names.insert(name).second)
      problems_.push_back({file_, pointer(), "key given twice", {}, {}, {}});
    return true;
  }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) override {
    std::string reason = error.what(), expected;
    if (const auto at = reason.find("] "); at != std::string::npos) reason.erase(0, at + 2);
    if (const auto at = reason.find(" - "); at != std::string::npos) reason.erase(0, at + 3);
    if (reason.starts_with("number overflow")) reason = "number too large";
    if (const auto at = reason.find("; expected "); at != std::string::npos) {
      expected = reason.substr(at + std::strlen("; expected "));
      reason.erase(at);
    }
    for (std::string* text : {&reason, &expected})
      if (const auto at = text->find("; last read"); at != std::string::npos) text->erase(at);
    const bool is_nul = position > 0 && position <= text_.size() && text_[position - 1] == '\0';
    if (is_nul) reason = "unexpected NUL byte";  // the parser takes it for the end
    const bool legible = reason.find("UTF-8") == std::string::npos;
    if (!legible) expected = "text in UTF-8: save it as such, or `iconv -f LATIN1 -t UTF-8 FILE`";
    const bool is_a_slip = reason.starts_with("invalid literal") || reason.starts_with("invalid number") ||
                           reason.starts_with("unexpected '");
    if (const auto mistake = is_a_slip ? mistake_at(text_, position - 1) : std::nullopt) {
      reason = mistake->what;
      expected = mistake->expected;
    }
    const std::string got = legible ? trimmed_line(text_, position) : std::string();
    problems_.push_back({file_, {}, line_and_column(text_, position) + ": " + reason, expected, got, {}});
    return false;
  }

 private:
  struct Level {
    std::optional<std::size_t> index{};  ///< in a list
    std::string key{};
    std::set<std::string> names{};
  };

  /// Ends the reading.
  bool refuse(std::string what, std::string expected) {
    if (!levels_.empty()) levels_.pop_back();
    problems_.push_back({file_, pointer(), std::move(what), std::move(expected), {}, {}});
    return false;
  }

  bool next() {
    constexpr std::size_t most = 10000;  // what compares each with all takes a second
    if (levels_.empty() || !levels_.back().index) return true;
    if (*levels_.back().index == most) return refuse("too long", fmt::format("a list of at most {}", most));
    ++*levels_.back().index;
    return true;
  }

  bool open(Level level) {
    // What reads, copies and prints a document calls itself once per level; this keeps the stack safe.
    constexpr std::size_t deepest = 100;
    if (levels_.size() == deepest) {
      levels_.clear();  // a pointer to it would fill the screen
      return refuse("nested too deeply", fmt::format("at most {} levels", deepest));
    }
    levels_.push_back(std::move(level));
    return true;
  }

  bool close() {
    levels_.pop_back();
    return next();
  }

  std::string pointer() const {
    std::string pointer;
    for (const Level& level : levels_)
      pointer.append("/").append(level.index ? std::to_string(*level.index) : pointer_token(level.key));
    return pointer;
  }

  const std::string& text_;
  const std::string& file_;
  std::vector<Level> levels_;
  std::vector<Problem> problems_;
};

[[noreturn]] void fail(Problem problem) { throw InputError({std::move(problem)}); }

/// What a path leads to, if it is neither a file nor nothing: a pipe could wait for ever, a device never end.
std::string not_a_file(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code ignored;  // what cannot be looked at fails to open, with its reason
  switch (fs::status(path, ignored).type()) {
  case fs::file_type::directory:
    return "is a folder";
  case fs::file_type::fifo:
    return "is a pipe";
  case fs::file_type::character:
  case fs::file_type::block:
    return "is a device";
  case fs::file_type::socket:
    return "is a socket";
  default:
    return {};
  }
}

/// All of a file that is not too large; no more is read of one that is.
std::string text_of(std::ifstream& file, const std::string& path) {
  constexpr std::size_t megabyte = 1'000'000;
  constexpr std::size_t most = 16 * megabyte;
  const std::string expected = fmt::format("at most {} MB", most / megabyte);
  std::error_code unknown;
  const auto size = std::filesystem::file_size(path, unknown);
  if (!unknown && size > most) fail({path, {}, "too large", expected, fmt::format("{} MB", size / megabyte), {}});
  std::string text;
  std::array<char, 65536> part{};
  while (file && text.size() <= most) {  // what /proc calls empty may be endless
    file.read(part.data(), part.size());
    text.append(part.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) fail({path, {}, "cannot be read to its end", {}, {}, {}});
  if (text.size() > most) fail({path, {}, "too large", expected, {}, {}});
  return text;
}

/// The file's neighbour that could be meant.
std::string closest_file(const std::filesystem::path& path) {
  std::vector<std::string> names;
  std::error_code unreadable;
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  for (std::filesystem::directory_iterator at(folder, unreadable), end; !unreadable && at != end;
       at.increment(unreadable))
    if (at->path().filename() != path.filename()) names.push_back(at->path().filename().string());
  std::sort(names.begin(), names.end());
  const std::string name = closest_name(path.filename().string(), names);
  return name.empty() ? name : (path.parent_path() / name).string();
}

/// The steps of a JSON pointer, unescaped.
std::vector<std::string> steps_of(const std::string& pointer, const std::string& file) {
  std::vector<std::string> steps;
  try {
    for (Json::json_pointer rest(pointer); !rest.empty(); rest.pop_back()) steps.push_back(rest.back());
  } catch (const Json::exception&) {
    steps.clear();
  }
  if (steps.empty()) fail({file, {}, "not a JSON pointer", "/key=value, like /time/end=2", shown(Json(pointer)), {}});
  std::reverse(steps.begin(), steps.end());
  return steps;
}

/// The element of a list that a step of a pointer names.
Json& element(Json& list, const std::string& step, const std::string& pointer, const std::string& file) {
  const bool is_index = !step.empty() && step.size() < 10 && step.find_first_not_of("0123456789") == std::string::npos;
  if (is_index && std::stoul(step) < list.size()) return list[std::stoul(step)];
  const std::string expected =
      list.empty() ? "nothing: the list is empty" : fmt::format("an index in [0, {}]", list.size() - 1);
  fail({file, pointer, "no such element", expected, shown(Json(step)), {}});
}

/// The place that a pointer names; objects and the last key are created.
Json& place_of(Json& document, const std::string& pointer, const std::string& file) {
  Json* place = &document;
  std::string walked;
  for (const std::string& step : steps_of(pointer, file)) {
    if (!place->is_null() && !place->is_structured())
      fail({file, walked, "has no keys", "an object or a list", shown(*place), {}});
    walked.append("/").append(pointer_token(step));
    place = place->is_array() ? &element(*place, step, walked, file) : &(*place)[step];
  }
  return *place;
}

}  // namespace

Json read_json(const std::string& path) {
  if (const std::string kind = not_a_file(path); !kind.empty()) fail({path, {}, kind, "a JSON file", {}, {}});
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file && errno == ENOENT) fail({path, {}, "no such file", {}, {}, closest_file(path)});
  if (!file) fail({path, {}, std::string("cannot be read: ") + std::strerror(errno), {}, {}, {}});
  return parse_json(text_of(file, path), path);
}

Json parse_json(const std::string& text, const std::string& file) {
  if (const auto mistake = mistake_of_encoding(text)) fail({file, {}, mistake->what, mistake->expected, {}, {}});
  if (without_byte_order_mark(text).find_first_not_of(" \t\r\n") == std::string::npos)
    fail({file, {}, "empty", "a JSON document", {}, {}});
  TextCheck check(text, file);
  Json::sax_parse(text, &check);
  if (!check.problems().empty()) throw InputError(check.problems());
  return Json::parse(text);
}

void set_value(Json& document, const std::string& assignment) {
  const std::string file = "--set " + assignment;
  const auto equals = assignment.find('=');
  if (equals == std::string::npos) fail({file, {}, "no value", "/pointer=JSON, like /time/end=2", {}, {}});
  const std::string pointer = assignment.substr(0, equals);
  const std::string value = assignment.substr(equals + 1);
  Json changed = document;
  Json& place = place_of(changed, pointer, file);
  if (!Json::accept(value)) {
    const std::string quoted = Json(value).dump(-1, ' ', false, Json::error_handler_t::replace);
    fail({file, pointer, "not JSON", "a JSON value, text in quotes: '" + quoted + "'", value, {}});
  }
  place = parse_json(value, file);
  document = std::move(changed);
}

void set_value(Json& document, const std::string& pointer, const Json& value, const std::string& file) {
  Json changed = document;
  place_of(changed, pointer, file) = value;
  document = std::move(changed);
}

}  // namespace minamo
