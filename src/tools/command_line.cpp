#include "tools/command_line.hpp"

#include <algorithm>
#include <boost/program_options/cmdline.hpp>
#include <boost/program_options/errors.hpp>
#include <boost/program_options/option.hpp>
#include <boost/program_options/options_description.hpp>
#include <boost/program_options/parsers.hpp>
#include <boost/program_options/value_semantic.hpp>
#include <cmath>
#include <locale>
#include <sstream>

#include "settings/suggestion.hpp"
#include "tools/formatted.hpp"

namespace tissue_stiffness {
namespace {

namespace po = boost::program_options;

constexpr std::size_t kWidth = 100, kIndent = 28;  // columns of the help, and where the meanings begin
constexpr int kStyle =
    po::command_line_style::unix_style & ~po::command_line_style::allow_guessing & ~po::command_line_style::allow_sticky;

bool is_negative_number(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && (word[1] == '.' || (word[1] >= '0' && word[1] <= '9'));
}

// Boost asks this first, and would take such a word for a short option.
std::vector<po::option> take_negative_number(std::vector<std::string>& words) {
  if (!is_negative_number(words.front())) return {};
  po::option number;
  number.value = number.original_tokens = {words.front()};
  words.erase(words.begin());
  return {number};
}

// Boost would take it for the value of the option before it.
bool looks_like_option(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && !is_negative_number(word);
}

std::string counted(std::size_t number) {
  return std::to_string(number) + (number == 1 ? " value" : " values");
}

// Breaks a text into lines, the first of which begins behind `head`.
std::string with_hanging_text(const std::string& head, const std::string& text) {
  std::string out, line = head + std::string(2, ' ');
  const auto next_line = [&] {
    out += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    line.clear();
  };
  if (line.size() > kIndent) next_line();
  line.resize(kIndent, ' ');
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (line.size() > kIndent && line.size() + word.size() > kWidth) {
      next_line();
      line.resize(kIndent, ' ');
    }
    line += word + " ";
  }
  next_line();
  return out;
}

}  // namespace

bool read_value(const std::string& text, std::string& value) {
  value = text;
  return true;
}

bool read_value(const std::string& text, double& value) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  return stream >> std::noskipws >> value && stream.peek() == std::istringstream::traits_type::eof() &&
         std::isfinite(value);
}

CommandArgument& CommandArgument::required(bool is) {
  required_ = is;
  return *this;
}

CommandArgument& CommandArgument::count(std::size_t least, std::size_t most) {
  least_ = least;
  most_ = most;
  return *this;
}

CommandArgument& CommandArgument::needs(const CommandArgument& other) {
  needed_ = &other;
  return *this;
}

CommandArgument& CommandArgument::one_of(const std::vector<std::string>& words) {
  words_ = words;
  allowed_ = join_words(words);
  holds_ = [words](const std::string& text) { return std::find(words.begin(), words.end(), text) != words.end(); };
  return *this;
}

CommandArgument& CommandArgument::positive() {
  allowed_ = "a positive " + kind_;
  holds_ = [](const std::string& text) {
    double value = 0.0;
    return read_value(text, value) && value > 0.0;
  };
  return *this;
}

CommandArgument& CommandArgument::between(double least, double most) {
  allowed_ = "a " + kind_ + formatted(" from %g to %g", least, most);
  holds_ = [least, most](const std::string& text) {
    double value = 0.0;
    return read_value(text, value) && value >= least && value <= most;
  };
  return *this;
}

std::string CommandArgument::form() const {
  const std::string repeated = most_ > 1 ? " ..." : "";
  if (is_positional()) return name_ + repeated;
  const std::string names = (short_name_.empty() ? "" : short_name_ + ", ") + name_;
  return is_flag() ? names : names + (kind_ == "text" ? " TEXT" : " NUMBER") + repeated;
}

std::string CommandArgument::description() const {
  return meaning_ + (words_.empty() ? "" : ": " + allowed_) + (required_ ? " (required)" : "") +
         (needed_ == nullptr ? "" : " (with " + needed_->name_ + ")");
}

void CommandArgument::read() const {
  if (!present_) return;
  if (is_flag()) {
    store_("");
    return;
  }
  if (given_.size() < least_ || given_.size() > most_) {
    const std::string allowed = least_ == most_ ? counted(least_)
                                : most_ == kAny ? counted(least_) + " or more"
                                                : std::to_string(least_) + " to " + counted(most_);
    throw UsageError(name_, counted(given_.size()), allowed);
  }
  for (const std::string& text : given_) {
    if ((!holds_ || holds_(text)) && store_(text)) continue;
    throw UsageError(name_, text.empty() ? "an empty text" : text + did_you_mean(text, words_), allowed_);
  }
}

void CommandArgument::check_presence() const {
  if (required_ && !present_) throw UsageError(name_ + " is required");
  if (present_ && needed_ != nullptr && !needed_->present_) throw UsageError(name_ + " requires " + needed_->name_);
}

CommandLine::CommandLine(std::string purpose, std::string tool) : purpose_(std::move(purpose)), tool_(std::move(tool)) {
  add("-h,--help", "print this help and exit");
  add("--version", "print the versions of the package and its libraries and exit");
}

CommandArgument& CommandLine::add_flag(const std::string& names, bool& value, const std::string& meaning) {
  CommandArgument& added = add(names, meaning);
  added.store_ = [&value](const std::string&) { return value = true; };
  return added;
}

CommandArgument& CommandLine::add(const std::string& names, const std::string& meaning, const std::string& kind) {
  CommandArgument& added = arguments_.emplace_back();
  const std::size_t comma = names.find(',');
  if (comma != std::string::npos) added.short_name_ = names.substr(0, comma);
  added.name_ = comma == std::string::npos ? names : names.substr(comma + 1);
  added.meaning_ = meaning;
  added.kind_ = kind;
  added.allowed_ = "a " + kind;
  if (kind.empty()) added.most_ = 0;
  return added;
}

CommandArgument* CommandLine::find(const std::string& name) {
  const auto found = std::find_if(arguments_.begin(), arguments_.end(),
                                  [&](const CommandArgument& a) { return a.name_ == name || a.short_name_ == name; });
  return found == arguments_.end() ? nullptr : &*found;
}

CommandLine::Wanted CommandLine::parse(const std::vector<std::string>& words) {
  const auto terminator = std::find(words.begin(), words.end(), "--");
  const auto asks_for = [&](const char* flag) { return std::find(words.begin(), terminator, flag) != terminator; };
  if (asks_for("--help") || asks_for("-h")) return Wanted::help;
  if (asks_for("--version")) return Wanted::versions;
  for (CommandArgument& argument : arguments_) {
    argument.present_ = false;
    argument.given_.clear();
  }
  const std::vector<std::string> behind(terminator == words.end() ? terminator : terminator + 1, words.end());
  std::vector<std::string> positional = give_to_options(split({words.begin(), terminator}), behind.size());
  positional.insert(positional.end(), behind.begin(), behind.end());
  give_to_positionals(positional);
  for (const CommandArgument& argument : arguments_) argument.read();
  for (const CommandArgument& argument : arguments_) argument.check_presence();
  return Wanted::run;
}

std::vector<CommandLine::Item> CommandLine::split(const std::vector<std::string>& words) {
  po::options_description known;
  std::vector<std::string> names;
  for (const CommandArgument& argument : arguments_) {
    if (argument.is_positional()) continue;
    names.push_back(argument.name_);
    const std::string short_name = argument.short_name_.empty() ? "" : "," + argument.short_name_.substr(1);
    known.add_options()((argument.name_.substr(2) + short_name).c_str(),
                        new po::untyped_value(argument.is_flag()));  // the description owns it
  }
  const auto no_such_option = [&](const std::string& typed) {
    const std::string name = typed.substr(0, typed.find('=', 3));
    return UsageError(name + ": no such option" + did_you_mean(name, names));
  };
  for (const std::string& word : words) {
    // Boost would take ---h for -h, and --=x for x.
    if (word.rfind("---", 0) == 0 || word.rfind("--=", 0) == 0) throw no_such_option(word);
  }
  std::vector<Item> items;
  try {
    po::command_line_parser parser(words);
    parser.options(known).style(kStyle).extra_style_parser(take_negative_number).allow_unregistered();
    for (const po::option& option : parser.run().options) {
      const std::string word = option.value.empty() ? "" : option.value.front();
      if (option.string_key.empty()) {
        items.push_back({nullptr, word});
        continue;
      }
      if (option.unregistered) throw no_such_option(option.original_tokens.front());
      CommandArgument* const argument = find("--" + option.string_key);
      const bool stands_apart = option.original_tokens.size() > 1;  // unlike --name=value
      if (stands_apart && looks_like_option(word)) throw UsageError(argument->name_, "no value", argument->allowed_);
      items.push_back({argument, word});
    }
  } catch (const po::invalid_command_line_syntax& error) {
    const CommandArgument* const argument = find(error.get_option_name());
    if (argument == nullptr) throw no_such_option(error.get_option_name());
    if (argument->is_flag()) throw UsageError(argument->name_, "a value", "the flag alone");
    throw UsageError(argument->name_, "no value", argument->allowed_);
  }
  return items;
}

std::vector<std::string> CommandLine::give_to_options(const std::vector<Item>& items, std::size_t more) {
  std::size_t lacking = 0;  // values of required positional arguments
  for (const CommandArgument& argument : arguments_)
    lacking += argument.is_positional() && argument.required_ ? argument.least_ : 0;
  const auto is_option = [](const Item& item) { return item.option != nullptr; };
  const auto last_words = std::find_if(items.rbegin(), items.rend(), is_option).base();
  std::vector<std::string> positional;
  CommandArgument* last = nullptr;
  for (auto item = items.begin(); item != items.end(); ++item) {
    if (is_option(*item)) {
      last = item->option;
      last->present_ = true;
      if (!last->is_flag()) last->given_.push_back(item->word);
      continue;
    }
    const std::size_t left = static_cast<std::size_t>(items.end() - item) + more;
    const bool spare = item < last_words || positional.size() + left > lacking;
    const bool takes = last != nullptr && last->given_.size() < last->most_ && spare;
    (takes ? last->given_ : positional).push_back(item->word);
  }
  return positional;
}

std::string CommandLine::usage() const {
  std::string line = tool_ + " [OPTIONS]";
  for (const CommandArgument& argument : arguments_) {
    if (argument.is_positional()) line += argument.required_ ? " " + argument.form() : " [" + argument.form() + "]";
  }
  return line;
}

void CommandLine::give_to_positionals(const std::vector<std::string>& words) {
  auto word = words.begin();
  for (CommandArgument& argument : arguments_) {
    if (!argument.is_positional()) continue;
    while (word != words.end() && argument.given_.size() < argument.most_) argument.given_.push_back(*word++);
    argument.present_ = !argument.given_.empty();
  }
  if (word != words.end()) throw UsageError(*word, "one argument too many", usage());
}

std::string CommandLine::help() const {
  std::string positional, options;
  for (const CommandArgument& argument : arguments_) {
    (argument.is_positional() ? positional : options) += with_hanging_text("  " + argument.form(), argument.description());
  }
  return purpose_ + "\nUsage: " + usage() + "\n" + (positional.empty() ? "" : "\nPositional arguments:\n" + positional) +
         "\nOptions:\n" + options + (footer_.empty() ? "" : "\n" + footer_ + "\n");
}

}  // namespace tissue_stiffness
