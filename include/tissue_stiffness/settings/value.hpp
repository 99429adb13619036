#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace tissue_stiffness {

/// A number of the model file, either known or estimated with a prior. `{prior: m, factor: f}` is log-normal with median m
/// and 1-sigma factor f > 1. `{mean: m, std: s}` is normal. `{value: v, tolerance: s}` is known to within s (1 sigma). An
/// estimated number with `drift: d` may change like a random walk while the body moves. After t seconds the log of a
/// log-normal number, or the value of a normal one, has moved by d sqrt(t) (1 sigma).
struct Quantity {
  enum class Kind { known, log_normal, normal };
  Kind kind = Kind::known;
  double value = 0.0;       ///< known value, median, or mean
  double spread = 0.0;      ///< factor (log_normal) or standard deviation (normal)
  double drift = 0.0;       ///< [1/sqrt(s)] (log_normal) or [unit/sqrt(s)] (normal); 0: constant
  double tolerance = -1.0;  ///< 1 sigma of a known value's error; below 0: the value in the key's spec

  bool estimated() const { return kind != Kind::known; }
};

/// One node of a settings tree, which comes from a YAML file or from ROS parameters. Every value knows its path
/// ("model.yaml:12: effects[1].elasticity.law") and whether it was read. So a key that nobody reads is an error.
class Value {
 public:
  enum class Type { null, boolean, number, text, list, map };

  static Value null(std::string path);
  static Value boolean(bool value, std::string path);
  static Value number(double value, std::string path);
  static Value text(std::string value, std::string path);
  static Value list(std::vector<Value> items, std::string path);
  static Value map(std::vector<std::pair<std::string, Value>> entries, std::string path);

  Type type() const { return type_; }
  const std::string& path() const { return path_; }
  std::string shown() const;  ///< the value as a user would write it, abbreviated

  /// Returns whether both have the same content, wherever it was written.
  bool same(const Value& other) const;

  bool has(const std::string& key) const;
  std::vector<std::string> keys() const;

  /// Returns an entry of a map and marks it as read. Throws InputError, naming the existing keys, when the entry is
  /// missing.
  const Value& at(const std::string& key) const;
  const std::vector<Value>& items() const;  ///< throws InputError unless this is a list; marks as read

  /// Each conversion marks the value as read. It throws InputError(path, shown, allowed) when the value does not fit.
  double as_number(double lower, double upper, const std::string& unit) const;
  int as_integer(int lower, int upper) const;
  bool as_boolean() const;
  std::string as_text() const;
  std::string as_choice(const std::vector<std::string>& allowed) const;
  Eigen::Vector3d as_vector3(const std::string& unit) const;
  Quantity as_quantity(double lower, double upper, const std::string& unit) const;

  /// These convert the entry with this key, or return `fallback` when the key is absent.
  double number_or(const std::string& key, double fallback, double lower, double upper, const std::string& unit) const;
  std::string text_or(const std::string& key, const std::string& fallback) const;

  void mark_read_deep() const;
  /// Throws InputError naming the first key below this value that nobody read, and the keys that were requested there.
  void require_all_read() const;

 private:
  Type type_ = Type::null;
  std::string path_;
  bool boolean_ = false;
  double number_ = 0.0;
  std::string text_;
  std::vector<Value> items_;
  std::vector<std::pair<std::string, Value>> entries_;
  mutable bool read_ = false;
  mutable std::vector<std::string> asked_;
};

/// Parses a YAML file. Throws InputError naming file and line for a file that is missing or not YAML.
Value load_yaml(const std::string& file);

/// Parses YAML text; `name` replaces the file's name in messages.
Value parse_yaml(const std::string& text, const std::string& name);

}  // namespace tissue_stiffness
