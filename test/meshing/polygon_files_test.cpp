// OBJ and PLY as other programs write them, and as nobody should.
#include "meshing/polygon_files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

class PolygonFiles : public testing::Test {
 protected:
  TriangleSurface obj(const std::string& content) { return read_obj(write(".obj", content)); }
  TriangleSurface ply(const std::string& content) { return read_ply(write(".ply", content)); }

  template <typename Read>
  static std::string refused(const Read& read) {
    try {
      read();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  std::string refused_obj(const std::string& content) {
    return refused([&] { obj(content); });
  }
  std::string refused_ply(const std::string& content) {
    return refused([&] { ply(content); });
  }

 private:
  static std::string write(const std::string& ending, const std::string& content) {
    const std::string file = testing::TempDir() + "polygon_files_test" + ending;
    std::ofstream(file, std::ios::binary) << content;
    return file;
  }
};

TEST_F(PolygonFiles, AnObjNumbersItsCornersFromOneOrFromTheLast) {
  const TriangleSurface surface =
      obj("# a square\no square\nv 0 0 0 0.5\nv 1 0 0\nvt 0 0\nv 1 1 0\nv 0 1 0\nusemtl skin\nf 1/1/1 2//2 3/1 4 # a "
          "face\nf -4 -3 -2\n");
  ASSERT_EQ(surface.vertex_count(), 4);
  ASSERT_EQ(surface.triangle_count(), 3);
  EXPECT_EQ(surface.vertices.col(2), Eigen::Vector3d(1, 1, 0));
  EXPECT_EQ(surface.triangles.col(0), Eigen::Vector3i(0, 1, 2));
  EXPECT_EQ(surface.triangles.col(1), Eigen::Vector3i(0, 2, 3));
  EXPECT_EQ(surface.triangles.col(2), Eigen::Vector3i(0, 1, 2));
}

TEST_F(PolygonFiles, AWrongObjIsRefused) {
  EXPECT_NE(refused_obj("v 0\n").find("polygon_files_test.obj"), std::string::npos);
  EXPECT_NE(refused_obj("v 0 0 zero\n").find("a number (z)"), std::string::npos);
  EXPECT_NE(refused_obj("v 0 0 0\nf 1 1\n").find("a face of 2 corners"), std::string::npos);
  EXPECT_NE(refused_obj("v 0 0 0\nf 1 1 0\n").find("corner '0'"), std::string::npos);
  EXPECT_NE(refused_obj("v 0 0 0\nf 1 1 -2\n").find("corner '-2'"), std::string::npos);
  EXPECT_NE(refused_obj("v 0 0 0\nf 1 1 a/b\n").find("corner 'a/b'"), std::string::npos);
  EXPECT_NE(refused_obj("v 0 0 0\nf 1 1 7\n").find("vertex 6"), std::string::npos);
}

const std::string kHeader =
    "ply\nformat FORMAT 1.0\ncomment made by hand\nobj_info none\nelement vertex 3\nproperty float x\nproperty uchar red\n"
    "property float y\nproperty double z\nelement edge 1\nproperty list uchar short weights\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n";

std::string header(const std::string& format) {
  std::string out = kHeader;
  return out.replace(out.find("FORMAT"), 6, format);
}

template <typename Number>
void append(std::string& bytes, Number number, bool swap) {
  char raw[sizeof(Number)];
  std::memcpy(raw, &number, sizeof(Number));
  if (swap) std::reverse(raw, raw + sizeof(Number));
  bytes.append(raw, sizeof(Number));
}

void expect_triangle(const TriangleSurface& surface) {
  ASSERT_EQ(surface.vertex_count(), 3);
  ASSERT_EQ(surface.triangle_count(), 1);
  EXPECT_EQ(surface.vertices.col(1), Eigen::Vector3d(1, 0.5, -2));
  EXPECT_EQ(surface.triangles.col(0), Eigen::Vector3i(2, 0, 1));
}

TEST_F(PolygonFiles, APlyIsReadInEachFormat) {
  expect_triangle(ply(header("ascii") + "0 255 0 0\n1 255 0.5 -2\n0 0 1 0\n2 -7 8\n3 2 0 1"));
  for (const bool swap : {false, true}) {
    std::string bytes = header(swap ? "binary_big_endian" : "binary_little_endian");
    for (const auto& [x, y, z] : {std::array<double, 3>{0, 0, 0}, {1, 0.5, -2}, {0, 1, 0}}) {
      append(bytes, static_cast<float>(x), swap);
      append(bytes, std::uint8_t{255}, swap);
      append(bytes, static_cast<float>(y), swap);
      append(bytes, z, swap);
    }
    append(bytes, std::uint8_t{1}, swap);
    append(bytes, std::int16_t{-7}, swap);
    append(bytes, std::uint8_t{3}, swap);
    for (const std::int32_t corner : {2, 0, 1}) append(bytes, corner, swap);
    expect_triangle(ply(bytes));
  }
}

TEST_F(PolygonFiles, AWrongPlyIsRefused) {
  const auto ascii = [](const std::string& vertices, const std::string& rest) {
    return "ply\nformat ascii 1.0\nelement vertex " + vertices +
           "\nproperty float x\nproperty float y\nproperty float z\n" + rest;
  };
  const std::string faces = "element face 1\nproperty list uchar int vertex_index\nend_header\n";
  EXPECT_NE(refused_ply("solid\n").find("allowed: ply"), std::string::npos);
  EXPECT_NE(refused_ply("ply\nformat binary 1.0\n").find("format 'binary'"), std::string::npos);
  EXPECT_NE(refused_ply("ply\nelement vertex 1\nproperty real x\n").find("type 'real'"), std::string::npos);
  EXPECT_NE(refused_ply("ply\nproperty float x\n").find("'property' in the header"), std::string::npos);
  EXPECT_NE(refused_ply("ply\nelement vertex 1\nproperty float x\nend_header\n1\n").find("vertices without y"),
            std::string::npos);
  EXPECT_NE(refused_ply(ascii("2000000000", "end_header\n1 2 3\n")).find("more bytes"), std::string::npos);
  EXPECT_NE(refused_ply(ascii("1", faces + "1 2 3\n255 0 0 0\n")).find("more bytes"), std::string::npos);
  EXPECT_NE(refused_ply(ascii("1", faces + "1 2 3\n3 0 0 1\n")).find("vertex 1 in triangle 0"), std::string::npos);
  EXPECT_NE(refused_ply(ascii("1", faces + "1 2 3\n3 0 0 0.5\n")).find("whole number"), std::string::npos);
  EXPECT_NE(refused_ply("ply\nformat ascii 1.0\n").find("the end of the file"), std::string::npos);
}

}  // namespace
}  // namespace tissue_stiffness
