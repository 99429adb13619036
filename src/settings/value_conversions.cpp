#include <cmath>
#include <limits>

#include "settings/suggestion.hpp"
#include "tissue_stiffness/settings/value.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double smallest = std::numeric_limits<double>::min();

std::string shown(double value) {
  return Value::number(value, "").shown();
}

std::string range_text(double lower, double upper, const std::string& unit) {
  std::string text = "a number";
  const bool positive = lower > 0.0 && lower <= smallest;  // this requires a number greater than zero
  if (positive) {
    text += " > 0";
  } else if (lower > -infinity) {
    text += upper < infinity ? " from " + shown(lower) : " >= " + shown(lower);
  }
  if (upper < infinity) {
    text += lower > -infinity && !positive ? " to " + shown(upper) : (positive ? " and <= " : " <= ") + shown(upper);
  }
  return unit.empty() || unit == "-" ? text : text + " [" + unit + "]";
}

void require_keys(const Value& value, const std::string& first, const std::string& second, const std::string& allowed) {
  const std::vector<std::string> keys = value.keys();
  const auto known = [&](const std::string& key) { return key == first || key == second || key == "drift"; };
  const bool complete = value.has(first) && value.has(second);
  if (!complete || !std::all_of(keys.begin(), keys.end(), known)) throw InputError(value.path(), value.shown(), allowed);
}

}  // namespace

double Value::as_number(double lower, double upper, const std::string& unit) const {
  read_ = true;
  if (type_ != Type::number || !(number_ >= lower && number_ <= upper) || !std::isfinite(number_)) {
    throw InputError(path_, shown(), range_text(lower, upper, unit));
  }
  return number_;
}

int Value::as_integer(int lower, int upper) const {
  read_ = true;
  const bool fits = type_ == Type::number && number_ >= lower && number_ <= upper && number_ == std::floor(number_);
  if (!fits) {
    throw InputError(path_, shown(), "a whole number from " + std::to_string(lower) + " to " + std::to_string(upper));
  }
  return static_cast<int>(number_);
}

bool Value::as_boolean() const {
  read_ = true;
  if (type_ != Type::boolean) throw InputError(path_, shown(), "true or false");
  return boolean_;
}

std::string Value::as_text() const {
  read_ = true;
  if (type_ != Type::text || text_.empty()) throw InputError(path_, shown(), "a text");
  return text_;
}

std::string Value::as_choice(const std::vector<std::string>& allowed) const {
  read_ = true;
  for (const std::string& choice : allowed) {
    if (type_ == Type::text && text_ == choice) return choice;
  }
  throw InputError(path_, shown() + (type_ == Type::text ? did_you_mean(text_, allowed) : ""), join_words(allowed));
}

Eigen::Vector3d Value::as_vector3(const std::string& unit) const {
  read_ = true;
  if (type_ != Type::list || items_.size() != 3) {
    throw InputError(path_, shown(), "three numbers [x, y, z]" + (unit.empty() || unit == "-" ? "" : " [" + unit + "]"));
  }
  Eigen::Vector3d vector;
  for (int i = 0; i < 3; ++i) vector[i] = items_[static_cast<std::size_t>(i)].as_number(-infinity, infinity, unit);
  return vector;
}

Quantity Value::as_quantity(double lower, double upper, const std::string& unit) const {
  const std::string allowed = range_text(lower, upper, unit) +
                              ", {prior, factor} or {mean, std}, with `drift` when it changes, or {value, tolerance}";
  read_ = true;
  Quantity quantity;
  if (type_ == Type::map && has("prior")) {
    require_keys(*this, "prior", "factor", allowed);
    quantity.kind = Quantity::Kind::log_normal;
    quantity.value = at("prior").as_number(std::max(lower, smallest), upper, unit);
    quantity.spread = at("factor").as_number(1.0, infinity, "");
    if (quantity.spread <= 1.0) throw InputError(at("factor").path(), at("factor").shown(), "a number > 1");
  } else if (type_ == Type::map && has("value")) {
    require_keys(*this, "value", "tolerance", allowed);
    quantity.value = at("value").as_number(lower, upper, unit);
    quantity.tolerance = at("tolerance").as_number(0.0, infinity, unit);
  } else if (type_ == Type::map) {
    require_keys(*this, "mean", "std", allowed);
    quantity.kind = Quantity::Kind::normal;
    quantity.value = at("mean").as_number(lower, upper, unit);
    quantity.spread = at("std").as_number(smallest, infinity, unit);
  } else if (type_ == Type::number) {
    quantity.value = as_number(lower, upper, unit);
  } else {
    throw InputError(path_, shown(), allowed);
  }
  if (quantity.estimated()) quantity.drift = number_or("drift", 0.0, 0.0, infinity, "");
  return quantity;
}

double Value::number_or(const std::string& key, double fallback, double lower, double upper,
                        const std::string& unit) const {
  return has(key) ? at(key).as_number(lower, upper, unit) : fallback;
}

std::string Value::text_or(const std::string& key, const std::string& fallback) const {
  return has(key) ? at(key).as_text() : fallback;
}

}  // namespace tissue_stiffness
