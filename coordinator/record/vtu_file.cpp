#include "coordinator/record/vtu_file.hpp"

#include <bit>
#include <cstdint>
#include <utility>

#include <fmt/format.h>
#include <zlib.h>
#include <pugixml.hpp>

#include "base/assert.hpp"
#include "coordinator/record/text_file.hpp"

namespace abut {
namespace {

constexpr std::size_t block_bytes = std::size_t{1} << 20;

void add_base64(std::span<const std::byte> bytes, std::string& out) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < count ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out.push_back(k <= count ? digits[group >> (18 - 6 * k) & 63u] : '=');
  }
}

template <class T>
std::string encode(std::span<const T> values) {
  return encode_array(std::as_bytes(values));
}

template <class T>
std::string encode(const std::vector<std::int32_t>& values) {
  std::vector<T> narrow;
  for (const std::int32_t value : values) narrow.push_back(static_cast<T>(value));
  return encode<T>(std::span<const T>(narrow));
}

void add_array(pugi::xml_node to, const char* type, const char* name, int components,
               const std::string& encoded) {
  pugi::xml_node array = to.append_child("DataArray");
  array.append_attribute("type") = type;
  array.append_attribute("Name") = name;
  array.append_attribute("NumberOfComponents") = components;
  array.append_attribute("format") = "binary";
  array.text() = encoded.c_str();
}

struct StringWriter final : pugi::xml_writer {
  std::string text;
  void write(const void* data, std::size_t size) override {
    text.append(static_cast<const char*>(data), size);
  }
};

}  // namespace

std::string encode_array(std::span<const std::byte> bytes) {
  const std::size_t blocks = (bytes.size() + block_bytes - 1) / block_bytes;
  std::vector<std::uint64_t> header{blocks, block_bytes, bytes.size() % block_bytes};
  std::vector<std::byte> packed;
  std::vector<std::byte> block(compressBound(block_bytes));
  for (std::size_t from = 0; from < bytes.size(); from += block_bytes) {
    const std::size_t count = std::min(block_bytes, bytes.size() - from);
    uLongf size = block.size();
    const int result =
        compress2(reinterpret_cast<Bytef*>(block.data()), &size,
                  reinterpret_cast<const Bytef*>(bytes.data() + from), count, Z_BEST_SPEED);
    ABUT_ASSERT(result == Z_OK);
    header.push_back(size);
    packed.insert(packed.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(size));
  }
  std::string out;
  out.reserve(4 * (packed.size() + 8 * header.size() + 6) / 3);
  add_base64(std::as_bytes(std::span(header)), out);
  add_base64(packed, out);
  return out;
}

VtuFile::VtuFile(const Grid& grid, std::vector<FieldInfo> fields)
    : fields_(std::move(fields)),
      nodes_(grid.nodes()),
      cells_(grid.cells()),
      points_(encode<double>(std::span(grid.points))),
      connectivity_(encode<std::int32_t>(std::span(grid.connectivity))),
      offsets_(encode<std::int32_t>(std::span(grid.offsets).subspan(1))),  // ends alone
      types_(encode<std::uint8_t>(grid.types)) {
  ABUT_ASSERT(unsound(grid).empty() && unsound(fields_).empty());
}

void VtuFile::write(const std::filesystem::path& path, double time,
                    std::span<const FieldValues> values) const {
  ABUT_ASSERT(unsound(values, fields_, nodes_, cells_).empty());
  pugi::xml_document document;
  pugi::xml_node file = document.append_child("VTKFile");
  file.append_attribute("type") = "UnstructuredGrid";
  file.append_attribute("version") = "1.0";
  file.append_attribute("byte_order") =
      std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
  file.append_attribute("header_type") = "UInt64";
  file.append_attribute("compressor") = "vtkZLibDataCompressor";
  pugi::xml_node whole = file.append_child("UnstructuredGrid");
  pugi::xml_node when = whole.append_child("FieldData").append_child("DataArray");
  when.append_attribute("type") = "Float64";
  when.append_attribute("Name") = "TimeValue";
  when.append_attribute("NumberOfTuples") = 1;
  when.append_attribute("format") = "ascii";
  when.text() = fmt::format("{}", time).c_str();
  pugi::xml_node piece = whole.append_child("Piece");
  piece.append_attribute("NumberOfPoints") = nodes_;
  piece.append_attribute("NumberOfCells") = cells_;
  pugi::xml_node at_nodes = piece.append_child("PointData");
  pugi::xml_node at_cells = piece.append_child("CellData");
  for (std::size_t k = 0; k < fields_.size(); ++k) {
    const FieldInfo& field = fields_[k];
    add_array(field.place == FieldPlace::nodes ? at_nodes : at_cells, "Float64", field.name.c_str(),
              field.components, encode<double>(std::span(values[k])));
  }
  add_array(piece.append_child("Points"), "Float64", "Points", 3, points_);
  pugi::xml_node cells = piece.append_child("Cells");
  add_array(cells, "Int32", "connectivity", 1, connectivity_);
  add_array(cells, "Int32", "offsets", 1, offsets_);
  add_array(cells, "UInt8", "types", 1, types_);
  StringWriter writer;
  document.save(writer, " ");
  write_whole(path, writer.text);
}

}  // namespace abut
