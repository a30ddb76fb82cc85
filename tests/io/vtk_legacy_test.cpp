// Legacy `.vtk` files that other programs write, and errors.
#include <algorithm>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include <hexhex/io.hpp>

#include <io/formats/formats.hpp>
#include <io/io_test_support.hpp>

namespace hexhex::test::vtk_legacy {

using namespace io;
namespace {

HexMesh parse(const std::string& text) {
  Context context;
  return readBytes<readVtkLegacy>(text, "m.vtk", context);
}

Failure failure(const std::string& text) {
  return failureOf([&] { static_cast<void>(parse(text)); });
}

/// Numbers with the largest byte first.
template <class T>
std::string big(std::initializer_list<T> values) {
  std::string result;
  for (const T value : values) {
    std::string bytes(reinterpret_cast<const char*>(&value), sizeof(value));
    std::reverse(bytes.begin(), bytes.end());
    result += bytes;
  }
  return result;
}

const std::string kHead =
    "# vtk DataFile Version 3.0\nany title\nASCII\nDATASET UNSTRUCTURED_GRID\n";
const std::string kPoints = "POINTS 8 double\n0 0 0 1 0 0 1 1 0\n0 1 0 0 0 1 1 0 1\n1 1 1 0 1 1\n";
const std::string kCells = "CELLS 1 9\n8 0 1 2 3 4 5 6 7\nCELL_TYPES 1\n12\n";
constexpr Hex kCubeCell = {0, 1, 2, 3, 4, 5, 6, 7};

std::string binaryHead(const std::string& version) {
  return "# vtk DataFile Version " + version + "\nany title\nBINARY\nDATASET UNSTRUCTURED_GRID\n";
}

template <class T>
std::string binaryPoints(const std::string& type) {
  return "POINTS 8 " + type + "\n" +
         big<T>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1}) + "\n";
}

TEST(VtkLegacyReader, VoxelsAreHexahedra) {
  const HexMesh mesh = parse(kHead + kPoints +
                             "CELLS 3 27\n8 0 1 3 2 4 5 7 6\n8 0 1 2 3 4 5 6 7\n"
                             "8 0 1 3 2 4 5 7 6\nCELL_TYPES 3\n11 12 11\n");
  EXPECT_EQ(mesh.cells, (Array<Hex>{kCubeCell, kCubeCell, kCubeCell}));
}

TEST(VtkLegacyReader, WhatIsAdvisedOnCurvedCellsFits) {
  const std::string hex = "27 0 1 2 3 4 5 6 7 0 1 2 3 4 5 6 7 0 1 2 3 4 5 6 7 0 1 2\n";
  const std::string alone =
      failure(kHead + kPoints + "CELLS 1 28\n" + hex + "CELL_TYPES 1\n29\n").sentence;
  EXPECT_NE(alone.find("`hexhex view`"), std::string::npos) << alone;
  const std::string mixed = failure(kHead + kPoints + "CELLS 2 39\n" + hex +
                                    "10 0 1 2 3 4 5 6 7 0 1\nCELL_TYPES 2\n29 24\n")
                                .sentence;
  EXPECT_EQ(mixed.find("`hexhex view`"), std::string::npos) << mixed;
  EXPECT_NE(mixed.find("Give the others a file of their own."), std::string::npos) << mixed;
}

TEST(VtkLegacyReader, OtherCellsAndArraysAreIgnored) {
  const HexMesh mesh =
      parse(kHead + "FIELD FieldData 2\nTIME 1 1 double\n0.5\nNAME 2 2 int\n1 2 3 4\n" + kPoints +
            "METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 2\n\n"
            "CELLS 3 19\n4 0 1 2 3\n8 0 1 2 3 4 5 6 7\n4 1 2 3 4\nCELL_TYPES 3\n9 12 10\n"
            "CELL_DATA 3\nSCALARS a double 1\nLOOKUP_TABLE default\n1 2 3\n");
  ASSERT_EQ(mesh.cells.size(), 1U);
  EXPECT_EQ(mesh.cells[0], kCubeCell);
  EXPECT_EQ(failure(kHead + kPoints + "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n").code,
            ErrorCode::FileUnsupported);
}

TEST(VtkLegacyReader, ArraysOfOtherProgramsTagCellsAndQuads) {
  const std::string cells =
      "CELLS 3 18\n4 0 1 2 3\n8 0 1 2 3 4 5 6 7\n3 0 1 2\nCELL_TYPES 3\n9 12 5\n";
  for (const std::string array :
       {"POINT_DATA 8\nSCALARS t double\nLOOKUP_TABLE default\n0 1 2 3 4 5 6 7\nCELL_DATA 3\n"
        "SCALARS region long\nLOOKUP_TABLE default\n5 -3 9\n",
        "CELL_DATA 3\nFIELD FieldData 1\ngmsh:physical 1 3 vtktypeint32\n5 -3 9\n",
        "CELL_DATA 3\nSCALARS material int\nLOOKUP_TABLE default\n5 -3 9\n"}) {
    SCOPED_TRACE(array);
    const HexMesh mesh = parse(kHead + kPoints + cells + array);
    EXPECT_EQ(mesh.regions, (Array<std::int32_t>{-3}));
    ASSERT_EQ(mesh.features.quads.size(), 1U);
    EXPECT_EQ(mesh.features.quads[0].vertices, (Quad{0, 1, 2, 3}));
    EXPECT_EQ(mesh.features.quads[0].tag, 5);
  }
}

TEST(VtkLegacyReader, OffsetsOfVersionFive) {
  const HexMesh mesh = parse(kHead + kPoints +
                             "CELLS 3 12\nOFFSETS vtktypeint64\n0 4 12\nCONNECTIVITY vtktypeint64\n"
                             "0 1 2 3 0 1 2 3 4 5 6 7\nCELL_TYPES 2\n10\n12\n");
  ASSERT_EQ(mesh.cells.size(), 1U);
  EXPECT_EQ(mesh.cells[0], kCubeCell);
}

TEST(VtkLegacyReader, Binary) {
  const std::string types = "\nCELL_TYPES 2\n" + big<std::int32_t>({10, 12}) + "\n";
  const std::string field =
      "FIELD FieldData 1\nbits 1 9 bit\n" + std::string("\n\n") + "\n";  // two bytes
  const HexMesh old =
      parse(binaryHead("4.2") + field + binaryPoints<float>("float") + "CELLS 2 14\n" +
            big<std::int32_t>({4, 0, 1, 2, 3, 8, 0, 1, 2, 3, 4, 5, 6, 7}) + types);
  const HexMesh recent = parse(binaryHead("5.1") + binaryPoints<double>("double") +
                               "CELLS 3 12\nOFFSETS vtktypeint64\n" +
                               big<std::int64_t>({0, 4, 12}) + "\nCONNECTIVITY vtktypeint64\n" +
                               big<std::int64_t>({0, 1, 2, 3, 0, 1, 2, 3, 4, 5, 6, 7}) + types);
  for (const HexMesh* mesh : {&old, &recent}) {
    EXPECT_EQ(mesh->points[5], (Vec3{1, 0, 1}));
    ASSERT_EQ(mesh->cells.size(), 1U);
    EXPECT_EQ(mesh->cells[0], kCubeCell);
  }
}

TEST(VtkLegacyReader, TypesBeforeCells) {
  const auto types = [](std::initializer_list<std::int32_t> list) {
    return "CELL_TYPES " + std::to_string(list.size()) + "\n" + big(list) + "\n";
  };
  const std::string cells = "CELLS 1 9\n" + big<std::int32_t>({8, 0, 1, 2, 3, 4, 5, 6, 7}) + "\n";
  const std::string begin = binaryHead("4.2") + binaryPoints<float>("float");
  const HexMesh mesh = parse(begin + types({12}) + cells);
  ASSERT_EQ(mesh.cells.size(), 1U);
  EXPECT_EQ(mesh.cells[0], kCubeCell);
  const Failure none = failure(begin + types({}) + cells);
  EXPECT_EQ(none.code, ErrorCode::FileSyntax);
  EXPECT_NE(none.sentence.find("1 cells but 0 types"), std::string::npos) << none.sentence;
}

const std::string kGood = kHead + kPoints + kCells;

/// The good file with one change must fail with this in the sentence.
void expectFailure(const std::string& from, const std::string& to, const std::string& fragment) {
  const Failure found = failure(replaced(kGood, from, to));
  EXPECT_NE(found.sentence.find(fragment), std::string::npos) << found.sentence;
}

TEST(VtkLegacyReader, ErrorsTellTheLine) {
  expectFailure("# vtk", "<?xml", "m.vtk, line 1: a .vtk file begins");
  expectFailure("UNSTRUCTURED_GRID", "FIELD", "m.vtk, line 4:");
  expectFailure("UNSTRUCTURED_GRID", "POLYDATA", "line 9: expected a section of the data set");
  expectFailure("0 1 0 0 0 1", "0 1 0 0 zero 1", "line 7: expected a coordinate of point 4");
  expectFailure("POINTS 8", "POINTS 99999", "has room for at most");
  expectFailure("CELLS 1 9\n8", "CELLS 1 9\n9", "cell 0 of 1 goes beyond");
  expectFailure("\nCELL_TYPES 1\n12", "", "without the section CELL_TYPES");
  expectFailure("CELL_TYPES 1\n12", "CELL_TYPES 2\n12 12", "1 cells but 2 types");
}

TEST(VtkLegacyReader, WrongCells) {
  EXPECT_EQ(failure(kHead + kPoints + "CELLS 1 8\n7 0 1 2 3 4 5 6\nCELL_TYPES 1\n12\n").code,
            ErrorCode::FileSyntax);
  for (const char* corner : {"8", "-1"}) {
    const Failure index =
        failure(replaced(kGood, "6 7\nCELL", std::string("6 ") + corner + "\nCELL"));
    EXPECT_EQ(index.code, ErrorCode::IndexOutOfRange);
    EXPECT_EQ(toString(index.place), "cell 0");
  }
  EXPECT_EQ(failure(binaryHead("5.1") + binaryPoints<double>("double") +
                    "CELLS 2 8\nOFFSETS vtktypeint64\n" + big<std::int64_t>({0, INT64_MIN}) +
                    "\nCONNECTIVITY vtktypeint64\n" + std::string(64, '\0') + "\nCELL_TYPES 1\n" +
                    big<std::int32_t>({12}) + "\n")
                .code,
            ErrorCode::FileSyntax);
}

}  // namespace
}  // namespace hexhex::test::vtk_legacy
