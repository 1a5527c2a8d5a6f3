// Goal: fields reach VTK's XML files unchanged, at the times that the scene wants, and nothing that
// is not finite does. Oracle: the numbers that were put in, read back by a decoder of the test's
// own.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <zlib.h>
#include <pugixml.hpp>

#include "base/error.hpp"
#include "base/index.hpp"
#include "coordinator/record/vtk_fields.hpp"
#include "coordinator/record/vtu_file.hpp"
#include "tests/support/fakes.hpp"

namespace abut::test_vtk_fields {
namespace {

namespace fs = std::filesystem;

std::vector<unsigned char> from_base64(std::string_view text) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<unsigned char>(bits >> count & 255u));
  }
  return bytes;
}

/// The sizes that begin an encoded array are a base64 text of their own.
std::vector<std::uint64_t> sizes_of(std::string_view text) {
  std::vector<std::uint64_t> sizes(3);
  std::memcpy(sizes.data(), from_base64(text.substr(0, 32)).data(), 24);
  sizes.resize(3 + sizes[0]);
  const std::size_t length = (8 * sizes.size() + 2) / 3 * 4;
  std::memcpy(sizes.data(), from_base64(text.substr(0, length)).data(), 8 * sizes.size());
  return sizes;
}

template <class T>
std::vector<T> decode_array(std::string_view text) {
  const std::vector<std::uint64_t> sizes = sizes_of(text);
  const std::vector<unsigned char> packed =
      from_base64(text.substr((8 * sizes.size() + 2) / 3 * 4));
  std::vector<unsigned char> bytes;
  std::size_t from = 0;
  for (std::size_t b = 0; b < sizes[0]; ++b) {
    const bool last = b + 1 == sizes[0] && sizes[2] != 0;
    std::vector<unsigned char> block(last ? sizes[2] : sizes[1]);
    uLongf size = block.size();
    EXPECT_EQ(uncompress(block.data(), &size, packed.data() + from, sizes[3 + b]), Z_OK);
    EXPECT_EQ(size, block.size());
    from += sizes[3 + b];
    bytes.insert(bytes.end(), block.begin(), block.end());
  }
  EXPECT_EQ(from, packed.size());
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!bytes.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

template <class T>
std::vector<T> array(pugi::xml_node parent, const char* name, int components) {
  const pugi::xml_node node = parent.find_child_by_attribute("DataArray", "Name", name);
  EXPECT_EQ(node.attribute("NumberOfComponents").as_int(), components) << name;
  EXPECT_STREQ(node.attribute("format").value(), "binary");
  return decode_array<T>(node.text().get());
}

class VtkFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(directory);
    fs::create_directories(directory);
  }
  void TearDown() override { fs::remove_all(directory); }

  pugi::xml_document xml(const fs::path& name) const {
    pugi::xml_document document;
    EXPECT_TRUE(document.load_file((directory / name).c_str())) << name;
    return document;
  }
  /// Times and files that fields.pvd lists.
  std::vector<std::pair<double, std::string>> listed() const {
    std::vector<std::pair<double, std::string>> entries;
    const pugi::xml_document document = xml("fields.pvd");
    for (pugi::xml_node entry : document.child("VTKFile").child("Collection").children("DataSet"))
      entries.emplace_back(entry.attribute("timestep").as_double(),
                           entry.attribute("file").value());
    return entries;
  }

  fs::path directory =
      fs::path(::testing::TempDir()) /
      (std::string("abut_vtk_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(VtkFiles, HoldGridAndFieldsToTheLastBit) {
  const Grid grid{{0, 0, 0, 1, 0, 0, 2, 0.1, 0}, {3, 1}, {0, 1, 2}, {0, 2, 3}};
  const std::vector<FieldInfo> fields{{"flow", FieldPlace::nodes, 3},
                                      {"a <b> & \"c\"", FieldPlace::cells, 1}};
  const std::vector<FieldValues> values{{1.0 / 3.0, -0.0, 5e-324, 1e308, 2, 3, 4, 5, 6}, {7, -8}};
  VtuFile(grid, fields).write(directory / "one.vtu", 0.125, values);
  const pugi::xml_document document = xml("one.vtu");
  const pugi::xml_node file = document.child("VTKFile");
  EXPECT_STREQ(file.attribute("type").value(), "UnstructuredGrid");
  EXPECT_STREQ(file.attribute("header_type").value(), "UInt64");
  EXPECT_STREQ(file.attribute("compressor").value(), "vtkZLibDataCompressor");
  const pugi::xml_node whole = file.child("UnstructuredGrid");
  EXPECT_EQ(whole.child("FieldData").child("DataArray").text().as_double(), 0.125);
  const pugi::xml_node piece = whole.child("Piece");
  EXPECT_EQ(piece.attribute("NumberOfPoints").as_int(), 3);
  EXPECT_EQ(piece.attribute("NumberOfCells").as_int(), 2);
  EXPECT_EQ(array<double>(piece.child("Points"), "Points", 3), grid.points);
  const pugi::xml_node cells = piece.child("Cells");
  EXPECT_EQ(array<std::int32_t>(cells, "connectivity", 1), grid.connectivity);
  EXPECT_EQ(array<std::int32_t>(cells, "offsets", 1), (std::vector<std::int32_t>{2, 3}));
  EXPECT_EQ(array<std::uint8_t>(cells, "types", 1), (std::vector<std::uint8_t>{3, 1}));
  const std::vector<double> flow = array<double>(piece.child("PointData"), "flow", 3);
  ASSERT_EQ(flow.size(), 9U);
  for (std::size_t i = 0; i < 9; ++i)
    EXPECT_EQ(std::bit_cast<std::uint64_t>(flow[i]), std::bit_cast<std::uint64_t>(values[0][i]));
  EXPECT_EQ(array<double>(piece.child("CellData"), "a <b> & \"c\"", 1), values[1]);
}

TEST(VtkArrays, OfAnySizeComeBack) {
  // Blocks hold 2^20 bytes: none, part of one, whole ones, one value more.
  for (const std::size_t count : {0U, 1U, 3U, 131071U, 131072U, 131073U, 262144U, 300001U}) {
    std::vector<double> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = std::sin(static_cast<double>(i));
    const std::string text = encode_array(std::as_bytes(std::span<const double>(values)));
    EXPECT_EQ(decode_array<double>(text), values) << count;
  }
}

/// A run of two point masses, of which one has no fields, in windows of 1 s.
struct FakeRun {
  explicit FakeRun(const fs::path& directory, int every)
      : silent(), observer(directory, {&told, &silent}, every) {
    start.bodies = {&told.describe(), &silent.describe()};
    observer.on_start(start);
    window(0, 0);
  }
  void window(int before, int after) {
    WindowReport report;
    report.window = {before, static_cast<double>(before), static_cast<double>(after)};
    report.windows = after;
    observer.on_window(report);
  }
  void end(const std::string& status, double time, bool bodies_there = true) {
    RunEnd end;
    end.status = status;
    end.time = time;
    if (bodies_there) end.state_hash = 1;
    observer.on_end(end);
  }

  struct Silent : FakeSubdomain {
    Silent() { nothing.name = "silent"; }
    const Description& describe() const override { return nothing; }
    Description nothing;
  };
  FakeSubdomain told;
  Silent silent;
  RunStart start;
  VtkFields observer;
};

TEST_F(VtkFiles, AreWrittenAtTheBeginEverySoManyWindowsAndAtTheEnd) {
  FakeRun run(directory, 3);
  for (int k = 0; k < 4; ++k) run.window(k, k + 1);
  run.window(4, 9);  // several windows of free flight
  run.window(9, 10);
  run.end("completed", 10.0);
  using Entries = std::vector<std::pair<double, std::string>>;
  EXPECT_EQ(listed(), (Entries{{0.0, "fields/fake_000000.vtu"},
                               {3.0, "fields/fake_000003.vtu"},
                               {9.0, "fields/fake_000009.vtu"},
                               {10.0, "fields/fake_000010.vtu"}}));
  EXPECT_EQ(run.told.counts.fields, 4);
  EXPECT_EQ(run.told.counts.grids, 1);
  EXPECT_EQ(run.silent.counts.fields + run.silent.counts.grids, 0);
  for (const auto& [time, file] : listed()) EXPECT_TRUE(fs::exists(directory / file)) << file;
}

TEST_F(VtkFiles, TheListIsWholeAfterEveryState) {
  FakeRun run(directory, 1);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(listed().size(), index(k + 1));
    run.window(k, k + 1);
  }
  run.end("interrupted", 3.0);
  EXPECT_EQ(listed().size(), 4U);  // the last window is the end
}

TEST_F(VtkFiles, TheEndOfAFailedRunAndOfLostBodiesIsNotAskedFor) {
  for (const bool lost : {false, true}) {
    SetUp();  // a folder of its own
    FakeRun run(directory, 5);
    run.window(0, 2);
    run.end(lost ? "interrupted" : "failed", 2.0, !lost);
    EXPECT_EQ(listed().size(), 1U);
    EXPECT_EQ(run.told.counts.fields, 1);
  }
}

TEST_F(VtkFiles, AValueThatIsNotFiniteEndsTheRunInWords) {
  FakeRun run(directory, 1);
  run.told.spoil_fields = [](std::vector<FieldValues>& values) {
    values[0][2] = std::numeric_limits<double>::quiet_NaN();
  };
  try {
    run.window(0, 1);
    FAIL() << "written";
  } catch (const RunError& error) {
    EXPECT_EQ(error.what_is_wrong, "field displacement is not finite at node 0 at 1 s");
    EXPECT_EQ(error.where, "body 'fake'");
  }
  EXPECT_FALSE(fs::exists(directory / "fields" / "fake_000001.vtu"));
  EXPECT_EQ(listed().size(), 1U);
}

TEST_F(VtkFiles, AFolderThatCannotBeWrittenEndsTheRunInWords) {
  FakeSubdomain body;
  VtkFields observer(directory / "missing", {&body}, 1);
  EXPECT_THROW(observer.on_start({}), RunError);
}

}  // namespace
}  // namespace abut::test_vtk_fields
