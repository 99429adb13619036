#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <locale>
#include <regex>
#include <set>
#include <sstream>

#include "tissue_stiffness/settings/value.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/read_file.hpp"

namespace tissue_stiffness {
namespace {

// YAML aliases can make a short file endlessly deep or exponentially large.
constexpr int deepest = 50;
constexpr int most_values = 1000000;
constexpr std::uintmax_t kLargestFile = 16000000;  // [byte]

class Converter {
 public:
  explicit Converter(std::string name) : name_(std::move(name)) {}

  /// `line` is the line of the key, because a block map starts on the line below. `key` is e.g. "effects[1].elasticity".
  Value convert(const YAML::Node& node, int line, const std::string& key, int depth) {
    const std::string path = key.empty() ? name_ : name_ + ":" + std::to_string(line + 1) + ": " + key;
    if (depth > deepest) throw InputError(path, "more than " + std::to_string(deepest) + " levels", "less nesting");
    if (++count_ > most_values) {
      throw InputError(path, "more than " + std::to_string(most_values) + " values", "a smaller file");
    }
    if (node.IsSequence()) return list(node, path, key, depth);
    if (node.IsMap()) return map(node, path, key, depth);
    return node.IsScalar() ? scalar(node, path) : Value::null(path);
  }

 private:
  Value list(const YAML::Node& node, const std::string& path, const std::string& key, int depth) {
    std::vector<Value> items;
    for (const YAML::Node& item : node) {
      items.push_back(convert(item, item.Mark().line, key + "[" + std::to_string(items.size()) + "]", depth + 1));
    }
    return Value::list(std::move(items), path);
  }

  Value map(const YAML::Node& node, const std::string& path, const std::string& prefix, int depth) {
    std::vector<std::pair<std::string, Value>> entries;
    std::set<std::string> seen;
    for (const auto& entry : node) {
      if (!entry.first.IsScalar()) throw InputError(path, "a key that is not a plain word", "plain words as keys");
      const std::string name = entry.first.Scalar();
      const std::string key = prefix.empty() ? name : prefix + "." + name;
      const int line = entry.first.Mark().line;
      if (!seen.insert(name).second) refuse_second(name, key, line);
      entries.emplace_back(name, convert(entry.second, line, key, depth + 1));
    }
    return Value::map(std::move(entries), path);
  }

  void refuse_second(const std::string& name, const std::string& key, int line) const {
    throw InputError(name_ + ":" + std::to_string(line + 1) + ": " + key, "the key `" + name + "` twice",
                     "one entry a key");
  }

  static Value scalar(const YAML::Node& node, const std::string& path) {
    static const std::regex number(R"([-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?)");
    const std::string& text = node.Scalar();
    if (node.Tag() == "!") return Value::text(text, path);  // quoted
    if (text == "true" || text == "false") return Value::boolean(text == "true", path);
    if (text.size() > 64 || !std::regex_match(text, number)) return Value::text(text, path);
    std::istringstream stream(text);
    stream.imbue(std::locale::classic());
    double value = 0.0;
    if (!(stream >> value)) return Value::text(text, path);  // out of range
    return Value::number(value, path);
  }

  std::string name_;
  int count_ = 0;
};

/// Notices where a document starts and whether it holds anything.
class DocumentProbe : public YAML::EventHandler {
 public:
  YAML::Mark start = YAML::Mark::null_mark();
  bool content = false;

  void OnDocumentStart(const YAML::Mark& mark) override { start = mark; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override { content = true; }
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override { content = true; }
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    content = true;
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    content = true;
  }
  void OnMapEnd() override {}
};

// YAML::LoadAll does not end where the parser stands still and finds one empty document after the other, as before ", a".
int count_documents(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  int count = 0;
  for (int last = -1;;) {
    DocumentProbe document;
    if (!parser.HandleNextDocument(document)) return count;
    if (document.start.pos <= last) throw YAML::ParserException(document.start, "a text that belongs to no value");
    last = document.start.pos;
    count += document.content ? 1 : 0;
  }
}

}  // namespace

Value parse_yaml(const std::string& text, const std::string& name) {
  try {
    const YAML::Node document = YAML::Load(text);
    const int count = count_documents(text);
    if (count > 1) throw InputError(name, std::to_string(count) + " YAML documents", "one");
    return Converter(name).convert(document, 0, "", 0);
  } catch (const YAML::Exception& error) {
    throw InputError(name + ":" + std::to_string(error.mark.line + 1), error.msg, "YAML");
  }
}

Value load_yaml(const std::string& file) {
  return parse_yaml(read_file(file, file, "a YAML file", kLargestFile), file);
}

}  // namespace tissue_stiffness
