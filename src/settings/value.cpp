#include "tissue_stiffness/settings/value.hpp"

#include <algorithm>
#include <cstdlib>

#include "settings/suggestion.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/formatted.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t shown_length = 60;

std::string shortened(std::string text) {
  if (text.size() <= shown_length) return text;
  return text.substr(0, shown_length - 3) + "...";
}

/// Writes the fewest digits that read back as the same number.
std::string shown_number(double value) {
  std::string text;
  for (int digits = 6; digits <= 17; ++digits) {
    text = formatted("%.*g", digits, value);
    if (std::strtod(text.c_str(), nullptr) == value) break;
  }
  return text;
}

void insert_once(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

}  // namespace

Value Value::null(std::string path) {
  Value v;
  v.path_ = std::move(path);
  return v;
}

Value Value::boolean(bool value, std::string path) {
  Value v = null(std::move(path));
  v.type_ = Type::boolean;
  v.boolean_ = value;
  return v;
}

Value Value::number(double value, std::string path) {
  Value v = null(std::move(path));
  v.type_ = Type::number;
  v.number_ = value;
  return v;
}

Value Value::text(std::string value, std::string path) {
  Value v = null(std::move(path));
  v.type_ = Type::text;
  v.text_ = std::move(value);
  return v;
}

Value Value::list(std::vector<Value> items, std::string path) {
  Value v = null(std::move(path));
  v.type_ = Type::list;
  v.items_ = std::move(items);
  return v;
}

Value Value::map(std::vector<std::pair<std::string, Value>> entries, std::string path) {
  Value v = null(std::move(path));
  v.type_ = Type::map;
  v.entries_ = std::move(entries);
  return v;
}

std::string Value::shown() const {
  std::string text;
  switch (type_) {
    case Type::null:
      return "nothing";
    case Type::boolean:
      return boolean_ ? "true" : "false";
    case Type::number:
      return shown_number(number_);
    case Type::text:
      return shortened("`" + text_) + "`";
    case Type::list:
      for (const Value& item : items_) {
        text += (text.empty() ? "" : ", ") + item.shown();
        if (text.size() > shown_length) break;
      }
      return shortened("[" + text + "]");
    case Type::map:
      break;
  }
  for (const auto& entry : entries_) {
    text += (text.empty() ? "" : ", ") + entry.first + ": " + entry.second.shown();
    if (text.size() > shown_length) break;
  }
  return shortened("{" + text + "}");
}

bool Value::same(const Value& other) const {
  const auto same_entry = [](const auto& a, const auto& b) { return a.first == b.first && a.second.same(b.second); };
  return type_ == other.type_ && boolean_ == other.boolean_ && number_ == other.number_ && text_ == other.text_ &&
         std::equal(items_.begin(), items_.end(), other.items_.begin(), other.items_.end(),
                    [](const Value& a, const Value& b) { return a.same(b); }) &&
         std::equal(entries_.begin(), entries_.end(), other.entries_.begin(), other.entries_.end(), same_entry);
}

bool Value::has(const std::string& key) const {
  insert_once(asked_, key);
  return std::any_of(entries_.begin(), entries_.end(), [&](const auto& entry) { return entry.first == key; });
}

std::vector<std::string> Value::keys() const {
  std::vector<std::string> names;
  for (const auto& entry : entries_) names.push_back(entry.first);
  return names;
}

const Value& Value::at(const std::string& key) const {
  if (type_ != Type::map) throw InputError(path_, shown(), "a map with the key `" + key + "`");
  insert_once(asked_, key);
  read_ = true;
  for (const auto& entry : entries_) {
    if (entry.first != key) continue;
    entry.second.read_ = true;
    return entry.second;
  }
  const std::string present = entries_.empty() ? "" : " among " + join_words(keys()) + did_you_mean(key, keys());
  throw InputError(path_, "no key `" + key + "`" + present, "`" + key + "` is required here");
}

const std::vector<Value>& Value::items() const {
  if (type_ != Type::list) throw InputError(path_, shown(), "a list");
  read_ = true;
  for (const Value& item : items_) item.read_ = true;
  return items_;
}

void Value::mark_read_deep() const {
  read_ = true;
  for (const Value& item : items_) item.mark_read_deep();
  for (const auto& entry : entries_) entry.second.mark_read_deep();
}

void Value::require_all_read() const {
  for (const Value& item : items_) item.require_all_read();
  for (const auto& entry : entries_) {
    if (!entry.second.read_) {
      std::vector<std::string> allowed = asked_;
      allowed.erase(std::remove(allowed.begin(), allowed.end(), entry.first), allowed.end());
      std::sort(allowed.begin(), allowed.end());
      throw InputError(entry.second.path_, "an unknown key `" + entry.first + "`" + did_you_mean(entry.first, allowed),
                       allowed.empty() ? "no keys" : join_words(allowed));
    }
    entry.second.require_all_read();
  }
}

}  // namespace tissue_stiffness
