#pragma once

#include <charconv>
#include <cstddef>
#include <deque>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {

/// A command line is wrong, whatever the files that it names hold.
class UsageError : public InputError {
 public:
  using InputError::InputError;
};

/// Reads the whole of a text as a value. Returns whether it is one.
bool read_value(const std::string& text, std::string& value);
/// Takes finite numbers only, with a point whatever the locale.
bool read_value(const std::string& text, double& value);
template <typename Integer>
bool read_value(const std::string& text, Integer& value) {
  const char* const end = text.data() + text.size();
  const auto [stop, fault] = std::from_chars(text.data(), end, value);
  return fault == std::errc() && stop == end;
}

/// One argument of a command line: a positional one, an option or a flag. Its functions say what is allowed.
class CommandArgument {
 public:
  CommandArgument& required(bool is = true);
  /// How many values it takes. Without this it is one, or any number for a vector.
  CommandArgument& count(std::size_t least, std::size_t most);
  /// It may only be given together with another argument.
  CommandArgument& needs(const CommandArgument& other);
  CommandArgument& one_of(const std::vector<std::string>& words);
  CommandArgument& positive();
  CommandArgument& between(double least, double most);

 private:
  friend class CommandLine;
  static constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();

  bool is_positional() const { return name_[0] != '-'; }
  bool is_flag() const { return most_ == 0; }
  /// What it looks like in the help, such as "-o, --output TEXT".
  std::string form() const;
  /// Its meaning and its conditions.
  std::string description() const;
  /// Checks the values that were given, and stores them.
  void read() const;
  /// Checks what does not depend on the values.
  void check_presence() const;

  std::string name_, short_name_;  ///< such as --output and -o
  std::string meaning_;
  std::string kind_, allowed_;        ///< such as "number" and "a positive number"
  std::vector<std::string> words_;    ///< the only values, where there are some
  std::size_t least_ = 1, most_ = 1;  ///< numbers of values
  bool required_ = false;
  const CommandArgument* needed_ = nullptr;
  std::function<bool(const std::string&)> store_;  ///< returns whether the text is a value
  std::function<bool(const std::string&)> holds_;  ///< returns whether the value is allowed
  bool present_ = false;
  std::vector<std::string> given_;  ///< texts of the values
};

/// The arguments of a tool, by Boost.Program_options. The variables that they are bound to must outlive it, and hold the
/// defaults. A vector's option takes all values up to the next option, and may be repeated. But the last words of the line
/// go to required positional arguments that have no value yet. Everything after `--` is positional.
class CommandLine {
 public:
  enum class Wanted { run, help, versions };

  CommandLine(std::string purpose, std::string tool);
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// Adds an argument that is known by its position. Only the last one may take several values.
  template <typename T>
  CommandArgument& add_positional(const std::string& name, T& value, const std::string& meaning) {
    return bind(name, value, meaning);
  }
  /// Adds an option with a value, such as "--output" or "-o,--output".
  template <typename T>
  CommandArgument& add_option(const std::string& names, T& value, const std::string& meaning) {
    return bind(names, value, meaning);
  }
  /// Adds an option without a value, which sets `value`.
  CommandArgument& add_flag(const std::string& names, bool& value, const std::string& meaning);
  /// What stands at the end of the help, in lines.
  void footer(std::string text) { footer_ = std::move(text); }

  /// Parses the words behind the tool's name, and stores the values. Where they ask for the help or the versions, it says
  /// so and looks at nothing else. Throws UsageError, which names the argument and what is allowed.
  Wanted parse(const std::vector<std::string>& words);
  /// Returns purpose, usage, positional arguments, options and footer.
  std::string help() const;
  const std::string& tool() const { return tool_; }

 private:
  /// Tells T, std::vector<T> and std::optional<T> apart.
  template <typename T>
  struct Values {
    using One = T;
    static constexpr bool several = false;
  };
  template <typename T>
  struct Values<std::vector<T>> {
    using One = T;
    static constexpr bool several = true;
  };
  template <typename T>
  struct Values<std::optional<T>> {
    using One = T;
    static constexpr bool several = false;
  };

  struct Item {
    CommandArgument* option;
    std::string word;
  };

  template <typename T>
  CommandArgument& bind(const std::string& names, T& value, const std::string& meaning);
  /// Adds an argument with one value that is bound to nothing. Without a kind it is a flag.
  CommandArgument& add(const std::string& names, const std::string& meaning, const std::string& kind = "");
  CommandArgument* find(const std::string& name);
  /// Splits words into options, each with a value unless it is a flag, and words without an option.
  std::vector<Item> split(const std::vector<std::string>& words);
  /// Gives the options their values. Returns the words that are positional; `more` will follow them.
  std::vector<std::string> give_to_options(const std::vector<Item>& items, std::size_t more);
  void give_to_positionals(const std::vector<std::string>& words);
  std::string usage() const;

  std::string purpose_, tool_, footer_;
  std::deque<CommandArgument> arguments_;  ///< never moved, because `needs` points at them
};

template <typename T>
CommandArgument& CommandLine::bind(const std::string& names, T& value, const std::string& meaning) {
  using One = typename Values<T>::One;
  constexpr bool is_text = std::is_same_v<One, std::string>, is_whole = std::is_integral_v<One>;
  CommandArgument& added = add(names, meaning, is_text ? "text" : is_whole ? "whole number" : "number");
  if (std::is_unsigned_v<One>) added.allowed_ += " from 0 on";
  if (Values<T>::several) added.most_ = CommandArgument::kAny;
  added.store_ = [&value](const std::string& text) {
    One one{};
    if (!read_value(text, one)) return false;
    if constexpr (Values<T>::several) {
      value.push_back(std::move(one));
    } else {
      value = std::move(one);
    }
    return true;
  };
  return added;
}

}  // namespace tissue_stiffness
