#include "engine/input_place.hpp"

#include <algorithm>
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

/// Looks for keys that nobody has read.
class UnknownKeys {
 public:
  explicit UnknownKeys(InputRecord& record) : record_(record) {}

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
    std::vector<std::string> unused;
    std::copy_if(place.known.begin(), place.known.end(), std::back_inserter(unused),
                 [&](const std::string& name) { return !place.object->contains(name); });
    std::string closest = closest_name(key, unused);
    const auto missing = place.missing.find(closest);
    const bool explains = missing != place.missing.end() && !settled_.contains(missing->second.front());
    if (!explains && place.unknown_keys_pass) return;
    if (closest.empty()) closest = closest_name(key, place.known);
    Problem problem{record_.file, place.pointer_to(key), "unknown key", {}, shown(value), closest};
    if (closest.empty()) {
      if (place.parent) problem.what += place.decided;  // of a whole document a choice decides too little to tell
      if (!place.known.empty()) problem.expected = one_of_text(possible_keys(place));
    }
    if (!explains) {
      record_.problems.push_back(std::move(problem));
      return;
    }
    const auto& answered = missing->second;  // its first problem becomes this one, in its place; the others go
    settled_.insert(answered.begin(), answered.end());
    explained_.insert(answered.begin() + 1, answered.end());
    record_.problems[answered.front()] = std::move(problem);
  }

  InputRecord& record_;
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
    : Document(std::make_shared<InputRecord>(InputRecord{std::move(file), {}, {}, {}, {}, {}})) {
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
  UnknownKeys unknown(*record_);
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
