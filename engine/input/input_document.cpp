#include "engine/input/input_place.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>

namespace minamo {

namespace {

/// The known keys without those that another one excludes.
std::vector<std::string> possible_keys(const InputPlace& place) {
  std::vector<std::string> keys;
  for (const std::string& key : place.known) {
    if (std::find(place.excluded.begin(), place.excluded.end(), key) == place.excluded.end()) keys.push_back(key);
  }
  return keys;
}

/// The steps of a pointer; a key alone is one.
std::vector<std::string> steps_along(std::string_view pointer) {
  std::vector<std::string> steps;
  std::size_t end = 0;
  for (std::size_t begin = pointer.starts_with('/') ? 1 : 0; end < pointer.size(); begin = end + 1) {
    end = std::min(pointer.find('/', begin), pointer.size());
    steps.emplace_back(pointer.substr(begin, end - begin));
  }
  return steps;
}

/// What a key could have been: a key of the same object, or one that a pointer leads to from the root.
struct Meant {
  std::string key;
  std::string expected = {};
};

/// Looks for keys that nobody has read.
class UnknownKeys {
 public:
  UnknownKeys(InputRecord& record, InputPlace& root) : record_(record), root_(root) {}

  void look_in(InputPlace& place) {
    if (!place.object) return;
    for (const auto& [key, value] : place.object->items()) {
      if (record_.problems.size() >= enough) return;
      const bool is_known = std::find(place.known.begin(), place.known.end(), key) != place.known.end();
      if (!is_known) note(place, key, value);
      const auto below = place.children.find(key);
      if (below == place.children.end()) continue;
      for (const auto& child : below->second)
        if (child) look_in(*child);
    }
  }

  /// Takes out the missing keys that unknown ones explain.
  void settle() {
    std::vector<Problem> kept;
    for (std::size_t i = 0; i < record_.problems.size(); ++i)
      if (!explained_.contains(i)) kept.push_back(std::move(record_.problems[i]));
    record_.problems = std::move(kept);
  }

 private:
  static constexpr std::size_t enough = 1000;  ///< problems: nobody reads more, and a file can have a million

  void note(InputPlace& place, const std::string& key, const Json& value) {
    Meant meant = meant_by(place, key);
    const auto* answered = missing_at(place, meant.key);
    const bool explains = answered && !settled_.contains(answered->front());
    if (!explains && place.unknown_keys_pass) return;
    if (meant.key.empty()) meant.key = closest_name(key, place.known);
    Problem problem{record_.file, place.pointer_to(key), "unknown key", meant.expected, shown(value), meant.key};
    if (meant.key.empty()) {
      if (place.parent) problem.what += place.decided;  // of a whole document a choice decides too little to tell
      if (!place.known.empty()) problem.expected = one_of_text(possible_keys(place));
    }
    if (!explains) {
      record_.problems.push_back(std::move(problem));
      return;
    }
    // Its first problem becomes this one, in its place; the others go.
    settled_.insert(answered->begin(), answered->end());
    explained_.insert(answered->begin() + 1, answered->end());
    record_.problems[answered->front()] = std::move(problem);
  }

  /// By the words of other programs: one that is not there yet, one that is, one of another place; or else by letters.
  Meant meant_by(const InputPlace& place, const std::string& key) const {
    std::optional<Meant> there;
    std::optional<Meant> elsewhere;
    for (const OtherWord& other : record_.words) {
      if (other.of != OtherWord::Of::key || !are_same_word(other.word, key)) continue;
      const std::string here = steps_along(other.means).back();
      const bool is_known = std::find(place.known.begin(), place.known.end(), here) != place.known.end();
      const std::string expected(other.expected);
      if (is_known && !place.object->contains(here)) return {here, expected};
      if (is_known && !there) there = Meant{here, expected};
      const bool is_pointer = other.means.starts_with('/') && other.means != place.pointer_to(key);  // not to itself
      if (is_pointer && !elsewhere)
        elsewhere = Meant{other.means == "/" + here && !place.parent ? here : std::string(other.means), expected};
    }
    if (there || elsewhere) return there ? *there : *elsewhere;
    std::vector<std::string> unused;
    std::copy_if(place.known.begin(), place.known.end(), std::back_inserter(unused),
                 [&](const std::string& name) { return !place.object->contains(name); });
    return {closest_name(key, unused)};
  }

  /// The problems noted because a key is missing; null if there are none.
  const std::vector<std::size_t>* missing_at(const InputPlace& place, const std::string& meant) const {
    const InputPlace* at = meant.starts_with('/') ? &root_ : &place;
    for (const std::string& step : steps_along(meant)) {
      const auto missing = at->missing.find(step);
      if (missing != at->missing.end()) return &missing->second;
      const auto below = at->children.find(step);
      if (below == at->children.end() || below->second.empty() || !below->second.front()) return nullptr;
      at = below->second.front().get();
    }
    return nullptr;
  }

  InputRecord& record_;
  InputPlace& root_;
  std::set<std::size_t> settled_;
  std::set<std::size_t> explained_;
};

std::shared_ptr<InputPlace> root_place(const std::shared_ptr<InputRecord>& record) {
  auto root = std::make_shared<InputPlace>();
  root->record = record;
  return root;
}

}  // namespace

Input::Input(std::shared_ptr<InputPlace> place) : place_(std::move(place)) {}

Input::Document::Document(std::shared_ptr<InputRecord> record)
    : record_(std::move(record)), root_(root_place(record_)) {}

Input::Document::Document(const Json& json, std::string file)
    : Document(std::make_shared<InputRecord>(InputRecord{std::move(file), {}, {}, {}, {}, {}, {}})) {
  InputPlace& root = *root_.place_;
  root.standing = InputPlace::Standing::present;
  if (json.is_object()) {
    root.object = &json;
    return;
  }
  root.note("", "wrong type", "an object", json);
  root.standing = InputPlace::Standing::silent;
}

Input::Document Input::Document::describe() {
  auto record = std::make_shared<InputRecord>();
  record->describing = true;
  return Document(std::move(record));
}

Input& Input::Document::root() { return root_; }

void Input::Document::finish() {
  UnknownKeys unknown(*record_, *root_.place_);
  unknown.look_in(*root_.place_);
  unknown.settle();
}

const std::vector<Problem>& Input::Document::problems() const { return record_->problems; }

const std::vector<std::string>& Input::Document::remarks() const { return record_->remarks; }

void Input::Document::require_valid() {
  if (!record_->problems.empty()) throw InputError(record_->problems);
}

Json Input::Document::echo() const { return root_.place_->echo; }

Json Input::Document::schema() const {
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}};
  schema.update(object_schema(*root_.place_->shape));
  return schema;
}

std::string Input::Document::key_table() const {
  return "| Key | Value | Default | Meaning |\n| --- | --- | --- | --- |\n" + table_rows(*root_.place_->shape, "");
}

}  // namespace minamo
