#include <sstream>

#include "meshing/polygon_files.hpp"
#include "meshing/polygon_soup.hpp"

namespace tissue_stiffness {
namespace {

// Returns the vertex that "7", "7/1" or "-1//3" names: from 1, or from the last one backwards. 0 is no vertex.
long long vertex_of(const std::string& corner, long long vertices) {
  std::istringstream stream(corner.substr(0, corner.find('/')));
  long long number = 0;
  if (!(stream >> number) || !stream.eof()) return -1;
  return number > 0 ? number - 1 : number < 0 ? vertices + number : -1;
}

void read_face(FileCursor& in, PolygonSoup& soup) {
  const std::string line = in.line();
  std::istringstream stream(line.substr(0, line.find('#')));
  std::vector<long long> corners;
  for (std::string corner; stream >> corner;) {
    corners.push_back(vertex_of(corner, soup.vertex_count()));
    if (corners.back() < 0) in.fail("corner '" + corner + "' of a face", "the number of a vertex");
  }
  if (corners.size() < 3) in.fail("a face of " + std::to_string(corners.size()) + " corners", "at least 3");
  soup.add_polygon(corners);
}

}  // namespace

TriangleSurface read_obj(const std::string& file) {
  FileCursor in(file);
  PolygonSoup soup;
  while (!in.at_end()) {
    const std::string word = in.word();
    if (word == "f") {
      read_face(in, soup);
      continue;
    }
    if (word == "v") {
      const double x = in.number("x"), y = in.number("y"), z = in.number("z");
      soup.add_vertex({x, y, z});
    }
    in.line();
  }
  return soup.surface(in);
}

}  // namespace tissue_stiffness
