#include "engine/schedule/schedule.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace minamo {

std::string_view name_of(Lifetime lifetime) {
  switch (lifetime) {
  case Lifetime::constant:
    return "constant";
  case Lifetime::state:
    return "state";
  case Lifetime::scratch:
    return "scratch";
  case Lifetime::cache:
    return "cache";
  }
  return {};
}

std::string_view name_of(OnRanks on_ranks) {
  switch (on_ranks) {
  case OnRanks::one_process:
    return "one process only";
  case OnRanks::own:
    return "own";
  case OnRanks::adds_up:
    return "adds up";
  case OnRanks::exchanges:
    return "exchanges";
  case OnRanks::alike_on_all:
    return "alike on all";
  case OnRanks::first_rank_writes:
    return "first rank writes";
  }
  return {};
}

namespace {

using Json = nlohmann::ordered_json;

std::string_view name_of(Mode mode) {
  switch (mode) {
  case Mode::read:
    return "read";
  case Mode::write:
    return "write";
  case Mode::update:
    return "update";
  case Mode::rows:
    return "rows";
  case Mode::resize:
    return "resize";
  }
  return {};
}

std::string_view mode_of(const Access& access) { return access.optional ? "optional read" : name_of(access.mode); }

std::string_view colour_of(Lifetime lifetime) {
  switch (lifetime) {
  case Lifetime::constant:
    return "#1b7837";
  case Lifetime::state:
    return "#2166ac";
  case Lifetime::scratch:
    return "#666666";
  case Lifetime::cache:
    return "#b35806";
  }
  return {};
}

/// The components that make `to` wait for `from`; a table's name where its rows are the reason.
std::vector<std::string> causes(const System& from, const System& to) {
  std::vector<std::string> names;
  for (const Access& x : from.access) {
    for (const Access& y : to.access) {
      if (!conflict(x, y)) continue;
      const bool by_rows = is_of_table(x.mode) || is_of_table(y.mode);
      const std::string name(by_rows ? x.table : x.component);
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

std::string in_quotes(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

std::string html(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
    case '&':
      result += "&amp;";
      break;
    case '<':
      result += "&lt;";
      break;
    case '>':
      result += "&gt;";
      break;
    case '"':
      result += "&quot;";
      break;
    default:
      result += c;
    }
  }
  return result;
}

std::string coloured(Lifetime lifetime, std::string_view text) {
  return "<font color=\"" + std::string(colour_of(lifetime)) + "\">" + html(text) + "</font>";
}

std::string box(std::string_view heading, const std::vector<std::string>& lines) {
  std::string result = "<<table border=\"0\" cellborder=\"1\" cellspacing=\"0\"><tr><td><b>";
  result += html(heading) + "</b></td></tr>";
  if (!lines.empty()) {
    result += "<tr><td align=\"left\">";
    for (const std::string& line : lines) result += line + "<br align=\"left\"/>";
    result += "</td></tr>";
  }
  return result + "</table>>";
}

std::string box_of(const System& system) {
  std::vector<std::string> lines;
  for (const Access& access : system.access) {
    lines.push_back(std::string(mode_of(access)) + " " +
                    (access.info ? coloured(access.info->lifetime, access.component) : html(access.table)));
  }
  return box(system.name, lines);
}

std::string legend() {
  return box("colours", {coloured(Lifetime::state, "state: carried from the step before"),
                         coloured(Lifetime::constant, "constant: written while the run is set up"),
                         coloured(Lifetime::scratch, "scratch: written anew in every step"),
                         coloured(Lifetime::cache, "cache: kept between steps to save work")});
}

Json json_of(const Access& access) {
  Json json = {
      {"mode", mode_of(access)}, {"component", nullptr}, {"table", nullptr}, {"unit", nullptr}, {"lifetime", nullptr}};
  if (!access.table.empty()) json["table"] = access.table;
  if (access.info) {
    json["component"] = access.component;
    json["unit"] = access.info->unit;
    json["lifetime"] = name_of(access.info->lifetime);
  }
  return json;
}

}  // namespace

std::string to_dot(std::span<const System> systems, std::string_view title) {
  std::string text = "digraph " + in_quotes(title) + " {\n  label=" + in_quotes(title) + ";\n";
  text += "  labelloc=t;\n  fontname=\"Helvetica\";\n";
  text += "  node [shape=plain, fontname=\"Helvetica\"];\n  edge [fontname=\"Helvetica\", fontsize=10];\n";
  for (std::size_t place = 0; place < systems.size(); ++place) {
    text += "  s" + std::to_string(place) + " [label=" + box_of(systems[place]) + "];\n";
  }
  for (const Edge& edge : derive_edges(systems)) {
    std::string label;
    for (const std::string& name : causes(systems[edge.from], systems[edge.to])) {
      label += (label.empty() ? "" : "\n") + name;
    }
    text +=
        "  s" + std::to_string(edge.from) + " -> s" + std::to_string(edge.to) + " [label=" + in_quotes(label) + "];\n";
  }
  return text + "  legend [label=" + legend() + "];\n}\n";
}

std::string to_json(std::span<const System> systems, std::string_view title) {
  Json json = {{"title", title}, {"systems", Json::array()}, {"edges", Json::array()}};
  for (const System& system : systems) {
    Json access = Json::array();
    for (const Access& line : system.access) access.push_back(json_of(line));
    json["systems"].push_back({{"name", system.name}, {"access", access}});
  }
  for (const Edge& edge : derive_edges(systems)) {
    json["edges"].push_back(
        {{"from", edge.from}, {"to", edge.to}, {"components", causes(systems[edge.from], systems[edge.to])}});
  }
  return json.dump(2) + "\n";
}

}  // namespace minamo
