#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>

#include "meshing/polygon_files.hpp"
#include "meshing/polygon_soup.hpp"

namespace tissue_stiffness {
namespace {

enum class Format { ascii, little_endian, big_endian };
enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

constexpr long long kMostEntries = 1LL << 31;

std::size_t size_of(Type type) {
  switch (type) {
    case Type::int8:
    case Type::uint8:
      return 1;
    case Type::int16:
    case Type::uint16:
      return 2;
    case Type::float64:
      return 8;
    default:
      return 4;
  }
}

struct Property {
  std::string name;
  Type type;
  bool list = false;
  Type count_type = Type::uint8;  ///< of a list
};

struct Element {
  std::string name;
  long long count;
  std::vector<Property> properties;
};

Type read_type(FileCursor& in) {
  static const std::map<std::string, Type> types{
      {"char", Type::int8},     {"int8", Type::int8},       {"uchar", Type::uint8},    {"uint8", Type::uint8},
      {"short", Type::int16},   {"int16", Type::int16},     {"ushort", Type::uint16},  {"uint16", Type::uint16},
      {"int", Type::int32},     {"int32", Type::int32},     {"uint", Type::uint32},    {"uint32", Type::uint32},
      {"float", Type::float32}, {"float32", Type::float32}, {"double", Type::float64}, {"float64", Type::float64}};
  const std::string word = in.word();
  const auto type = types.find(word);
  if (type == types.end()) in.fail("type '" + word + "'", "char, uchar, short, ushort, int, uint, float or double");
  return type->second;
}

Property read_property(FileCursor& in) {
  Property out;
  if (in.peek() == "list") {
    in.word();
    out.list = true;
    out.count_type = read_type(in);
  }
  out.type = read_type(in);
  out.name = in.word();
  return out;
}

Format read_format(FileCursor& in) {
  const std::string word = in.word();
  in.line();
  if (word == "ascii") return Format::ascii;
  if (word == "binary_little_endian") return Format::little_endian;
  if (word == "binary_big_endian") return Format::big_endian;
  in.fail("format '" + word + "'", "ascii, binary_little_endian or binary_big_endian");
}

template <typename Number>
double number_of(const char* bytes) {
  Number number;
  std::memcpy(&number, bytes, sizeof(number));
  return static_cast<double>(number);
}

// Reads the numbers of one format. The machines we build for are little-endian.
class Numbers {
 public:
  Numbers(FileCursor& in, Format format) : in_(in), format_(format) {}

  double read(Type type) {
    if (format_ == Format::ascii) return in_.number("a property");
    const std::size_t size = size_of(type);
    char bytes[8];
    std::memcpy(bytes, in_.binary(size, "a property"), size);
    if (format_ == Format::big_endian) std::reverse(bytes, bytes + size);
    switch (type) {
      case Type::int8:
        return number_of<std::int8_t>(bytes);
      case Type::uint8:
        return number_of<std::uint8_t>(bytes);
      case Type::int16:
        return number_of<std::int16_t>(bytes);
      case Type::uint16:
        return number_of<std::uint16_t>(bytes);
      case Type::int32:
        return number_of<std::int32_t>(bytes);
      case Type::uint32:
        return number_of<std::uint32_t>(bytes);
      case Type::float32:
        return number_of<float>(bytes);
      case Type::float64:
        break;
    }
    return number_of<double>(bytes);
  }
  // Returns a whole number from 0 that is small enough to be one of the file.
  long long read_whole(Type type, const std::string& what) {
    const double number = read(type);
    if (!(number >= 0.0 && number < static_cast<double>(kMostEntries)) ||
        number != static_cast<double>(static_cast<long long>(number))) {
      in_.fail(what + " " + std::to_string(number), "a whole number from 0");
    }
    return static_cast<long long>(number);
  }
  // Returns the fewest bytes that a number takes: a digit and what parts it from the next, where it is text.
  std::size_t least(Type type) const { return format_ == Format::ascii ? 2 : size_of(type); }

 private:
  FileCursor& in_;
  Format format_;
};

std::vector<Element> read_header(FileCursor& in, Format& format) {
  if (in.line() != "ply") in.fail("another first line", "ply");
  std::vector<Element> elements;
  for (std::string word = in.word(); word != "end_header"; word = in.word()) {
    if (word == "format") {
      format = read_format(in);
    } else if (word == "element") {
      const std::string name = in.word();
      elements.push_back({name, in.integer("entries of " + name, 0, kMostEntries), {}});
    } else if (word == "property" && !elements.empty()) {
      elements.back().properties.push_back(read_property(in));
    } else if (word == "comment" || word == "obj_info") {
      in.line();
    } else {
      in.fail("'" + word + "' in the header", "format, element, property, comment or end_header");
    }
  }
  in.line();
  return elements;
}

std::vector<long long> read_list(FileCursor& in, const Property& property, Numbers& numbers, bool corners) {
  const long long count = numbers.read_whole(property.count_type, "a list's length");
  in.require(count, numbers.least(property.type), property.name);
  std::vector<long long> out;
  for (long long i = 0; i < count; ++i) {
    if (corners) {
      out.push_back(numbers.read_whole(property.type, "vertex"));
    } else {
      numbers.read(property.type);
    }
  }
  return out;
}

void read_entry(FileCursor& in, const Element& element, Numbers& numbers, PolygonSoup& soup) {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  for (const Property& property : element.properties) {
    if (property.list) {
      const bool corners = element.name == "face" && (property.name == "vertex_indices" || property.name == "vertex_index");
      const std::vector<long long> list = read_list(in, property, numbers, corners);
      if (corners) soup.add_polygon(list);
      continue;
    }
    const double number = numbers.read(property.type);
    if (property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z')
      point[property.name[0] - 'x'] = number;
  }
  if (element.name == "vertex") soup.add_vertex(point);
}

}  // namespace

TriangleSurface read_ply(const std::string& file) {
  FileCursor in(file);
  Format format = Format::ascii;
  const std::vector<Element> elements = read_header(in, format);
  Numbers numbers(in, format);
  PolygonSoup soup;
  for (const Element& element : elements) {
    if (element.count == 0) continue;
    if (element.properties.empty()) in.fail(element.name + " without properties", "at least one");
    const bool vertex = element.name == "vertex";
    for (const char* axis : {"x", "y", "z"}) {
      const auto same = [&](const Property& property) { return property.name == axis && !property.list; };
      if (vertex && std::none_of(element.properties.begin(), element.properties.end(), same)) {
        in.fail("vertices without " + std::string(axis), "x, y and z");
      }
    }
    in.require(element.count, element.properties.size(), element.name);
    for (long long i = 0; i < element.count; ++i) read_entry(in, element, numbers, soup);
  }
  return soup.surface(in);
}

}  // namespace tissue_stiffness
