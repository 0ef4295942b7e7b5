#include "document.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <string_view>
#include <utility>

#include "override_hint.hpp"

namespace poreshock::scene_text {
namespace {

/// A table that is walked into, not put in place of another: written as a.b, not as { ... }.
toml::table* walked_table(toml::node& node) {
  toml::table* table = node.as_table();
  return table != nullptr && !table->is_inline() ? table : nullptr;
}

void merge(toml::table& from, toml::table& into, const std::string& path, const Origin& origin,
           Report& report);

/// Index of an entry of an array; empty, with a problem reported, when there is no such entry.
std::optional<std::size_t> entry_index(std::string_view key, std::size_t entries,
                                       const std::string& path, const Origin& origin,
                                       Report& report) {
  std::size_t index = 0;
  const auto result = std::from_chars(key.data(), key.data() + key.size(), index);
  if (result.ec == std::errc{} && result.ptr == key.data() + key.size() && index < entries) {
    return index;
  }
  const std::string allowed = entries == 0 ? "the list is empty"
                              : entries == 1
                                  ? "allowed the index 0"
                                  : "allowed an index from 0 to " + std::to_string(entries - 1);
  add_problem_at(origin, path, "found the entry \"" + std::string(key) + "\", " + allowed, report);
  return std::nullopt;
}

void merge_entries(toml::table& from, toml::array& into, const std::string& path,
                   const Origin& origin, Report& report) {
  for (auto&& [key, node] : from) {
    const auto index = entry_index(key.str(), into.size(), path, origin, report);
    if (!index) continue;
    const std::string entry_path = path + "." + std::string(key.str());
    toml::table* source = walked_table(node);
    toml::table* target = into.get(*index)->as_table();
    if (source != nullptr && target != nullptr) {
      merge(*source, *target, entry_path, origin, report);
    } else if (source != nullptr) {
      add_problem_at(origin, entry_path, "found a key inside it, but it is not a table", report);
    } else {
      const auto position = into.cbegin() + static_cast<std::ptrdiff_t>(*index);
      node.visit([&](auto& value) { into.replace(position, std::move(value)); });
    }
  }
}

/// Moves the values of `from` into `into`; moved values keep where they were written.
void merge(toml::table& from, toml::table& into, const std::string& path, const Origin& origin,
           Report& report) {
  for (auto&& [key, node] : from) {
    const std::string inner_path =
        path.empty() ? std::string(key.str()) : path + "." + std::string(key.str());
    toml::table* source = walked_table(node);
    toml::node* target = into.get(key.str());
    if (source == nullptr || target == nullptr) {
      const toml::key name = key;
      node.visit([&](auto& value) { into.insert_or_assign(name, std::move(value)); });
    } else if (toml::table* table = target->as_table()) {
      merge(*source, *table, inner_path, origin, report);
    } else if (toml::array* array = target->as_array()) {
      merge_entries(*source, *array, inner_path, origin, report);
    } else {
      add_problem_at(origin, inner_path, "found a key inside it, but it is not a table", report);
    }
  }
}

bool is_bare_word(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
}

/// Parses "table.key=value". A shell eats the quotes of a string, so a value that is one word and
/// not TOML is taken as a string. Throws toml::parse_error.
toml::table parse_override(const std::string& text, std::size_t equals, const std::string& source) {
  try {
    return toml::parse(text, std::string_view(source));
  } catch (const toml::parse_error&) {
    const std::string value = text.substr(equals + 1);
    if (!is_bare_word(value)) throw;
    return toml::parse(text.substr(0, equals + 1) + '"' + value + '"', std::string_view(source));
  }
}

void apply_override(const std::string& text, toml::table& document, Report& report) {
  const Origin origin{"--set " + text};
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || text.find('\n') != std::string::npos) {
    add_problem_at(origin, "", "found no value, allowed table.key=value such as time.end=2e-7",
                   report);
    return;
  }
  if (equals + 1 == text.size()) {
    add_problem_at(origin, "", "found nothing after the =, allowed a value such as time.end=2e-7",
                   report);
    return;
  }
  const std::string value = text.substr(equals + 1);
  const std::string hint = is_bare_word(value) ? "" : override_hint(text);
  if (!hint.empty()) {
    add_problem_at(origin, "", hint, report);
    return;
  }
  try {
    toml::table change = parse_override(text, equals, origin.source);
    merge(change, document, "", origin, report);
  } catch (const toml::parse_error& error) {
    add_problem_at(origin, "", "not valid TOML: " + std::string(error.description()), report);
  }
}

}  // namespace

std::optional<toml::table> parse_document(const std::string& text, const std::string& name,
                                          const std::vector<std::string>& overrides,
                                          Report& report) {
  std::optional<toml::table> document;
  try {
    document = toml::parse(text, std::string_view(name));
  } catch (const toml::parse_error& error) {
    const toml::source_position place = error.source().begin;
    const std::string reason(error.description());
    const bool bare = reason.find("could not determine value type") != std::string::npos;
    add_problem_at({name, place.line, place.column}, "",
                   "not valid TOML: " + reason + (bare ? "; a text stands in quotes" : ""), report);
  }
  toml::table nowhere;
  for (const std::string& change : overrides) {
    apply_override(change, document ? *document : nowhere, report);
  }
  return document;
}

}  // namespace poreshock::scene_text
