#include "packing/polydata_xml.h"

#include <expat.h>

#include <charconv>
#include <map>
#include <memory>
#include <optional>

#include "base/error.h"

namespace pendular {
namespace {

constexpr std::int64_t kMostComponents = 64;
constexpr std::string_view kAppended = "<AppendedData";

using Attributes = std::map<std::string, std::string>;

/// Builds a PolyXml from the parser's calls. Its complaints end the parsing.
class Builder {
 public:
  Builder(PolyXml& xml, std::uint64_t file_size)
      : xml_(xml), most_(static_cast<std::int64_t>(kDeflateLimit * file_size)) {}

  void start(const std::string& name, const Attributes& attributes) {
    path_.push_back(name);
    if (path_.size() == 1) return start_file(name, attributes);
    if (name == "Piece") return start_piece(attributes);
    if (name == "AppendedData") xml_.raw_appended = word(attributes, "encoding", "base64") == "raw";
    if (name == "DataArray" || name == "Array") start_array(attributes);
  }

  void end() {
    if (path_.back() == "DataArray" || path_.back() == "Array") array_ = nullptr;
    path_.pop_back();
  }

  void characters(std::string_view text) {
    const bool of_array = array_ && (path_.back() == "DataArray" || path_.back() == "Array");
    if (of_array && array_->format != XmlArray::Format::appended) array_->text += text;
  }

  int pieces() const { return pieces_; }

 private:
  static std::string word(const Attributes& attributes, const char* key, const char* otherwise = "") {
    const auto found = attributes.find(key);
    return found == attributes.end() ? otherwise : found->second;
  }

  static std::int64_t count(const Attributes& attributes, const char* key, std::int64_t lowest,
                            std::int64_t highest, std::int64_t otherwise) {
    const auto found = attributes.find(key);
    if (found == attributes.end()) return otherwise;
    const std::string& text = found->second;
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < lowest || value > highest)
      bad_input("{}: found \"{}\", expected a whole number from {} to {}", key, text, lowest, highest);
    return value;
  }

  void start_file(const std::string& name, const Attributes& attributes) {
    if (name != "VTKFile" || word(attributes, "type") != "PolyData")
      bad_input("is no VTK PolyData XML file (.vtp)");
    const std::string heads = word(attributes, "header_type", "UInt32"),
                      packer = word(attributes, "compressor"),
                      order = word(attributes, "byte_order", "LittleEndian");
    if (heads != "UInt32" && heads != "UInt64")
      bad_input("header_type: found \"{}\", expected UInt32 or UInt64", heads);
    if (!packer.empty() && packer != "vtkZLibDataCompressor")
      bad_input("compressor: found \"{}\", expected none or vtkZLibDataCompressor", packer);
    if (order != "LittleEndian" && order != "BigEndian")
      bad_input("byte_order: found \"{}\", expected LittleEndian or BigEndian", order);
    xml_.wide_heads = heads == "UInt64";
    xml_.deflated = !packer.empty();
    xml_.big_endian = order == "BigEndian";
  }

  void start_piece(const Attributes& attributes) {
    if (++pieces_ > 1) bad_input("found several pieces, expected one");
    const auto number = [&](const char* key) { return count(attributes, key, 0, most_, 0); };
    xml_.points = number("NumberOfPoints");
    xml_.verts = number("NumberOfVerts");
    xml_.lines = number("NumberOfLines");
    xml_.strips = number("NumberOfStrips");
    xml_.polys = number("NumberOfPolys");
  }

  /// The list that an array in this element belongs to; null for those that are of no interest.
  std::vector<XmlArray>* list() {
    const std::string& parent = path_.size() < 2 ? path_.back() : path_[path_.size() - 2];
    if (parent == "FieldData") return &xml_.fields;
    if (parent == "PointData") return &xml_.point_data;
    if (parent == "CellData") return &xml_.cell_data;
    if (parent == "Points") return &xml_.coordinates;
    if (parent == "Lines") return &xml_.line_ends;
    return nullptr;
  }

  void start_array(const Attributes& attributes) {
    auto* const arrays = list();
    if (!arrays) return;
    XmlArray array;
    array.name = word(attributes, "Name");
    array.type = word(attributes, "type");
    array.components = count(attributes, "NumberOfComponents", 1, kMostComponents, 1);
    array.tuples = count(attributes, "NumberOfTuples", 0, most_, -1);
    array.offset = static_cast<std::uint64_t>(count(attributes, "offset", 0, most_, 0));
    const std::string format = word(attributes, "format", "ascii");
    if (format == "binary")
      array.format = XmlArray::Format::binary;
    else if (format == "appended")
      array.format = XmlArray::Format::appended;
    else if (format != "ascii")
      bad_input("array {}: format: found \"{}\", expected ascii, binary or appended", array.name, format);
    for (const auto& other : *arrays)
      if (!array.name.empty() && other.name == array.name) bad_input("array {}: found twice", array.name);
    arrays->push_back(std::move(array));
    array_ = &arrays->back();
  }

  PolyXml& xml_;
  std::int64_t most_;
  std::vector<std::string> path_;
  XmlArray* array_ = nullptr;
  int pieces_ = 0;
};

/// What the library's callbacks share. An exception must not go through it, so it waits here.
struct Parsing {
  XML_Parser parser;
  Builder builder;
  std::optional<std::string> complaint;

  template <typename Call>
  void guarded(const Call& call) {
    if (complaint) return;
    try {
      call();
    } catch (const BadInput& error) {
      complaint = error.what();
      XML_StopParser(parser, XML_FALSE);
    }
  }
};

Parsing& parsing(void* data) {
  return *static_cast<Parsing*>(data);
}

void XMLCALL on_start(void* data, const XML_Char* name, const XML_Char** pairs) {
  parsing(data).guarded([&] {
    Attributes attributes;
    for (; pairs[0] != nullptr; pairs += 2) attributes.emplace(pairs[0], pairs[1]);
    parsing(data).builder.start(name, attributes);
  });
}

void XMLCALL on_end(void* data, const XML_Char*) {
  parsing(data).guarded([&] { parsing(data).builder.end(); });
}

void XMLCALL on_characters(void* data, const XML_Char* text, int length) {
  parsing(data).guarded(
      [&] { parsing(data).builder.characters(std::string_view(text, static_cast<std::size_t>(length))); });
}

void XMLCALL on_document_type(void* data, const XML_Char*, const XML_Char*, const XML_Char*, int) {
  parsing(data).guarded([] { bad_input("found a document type, expected none"); });
}

/// Appended data start after the first '_' of their element, and may be no XML at all: what stands before
/// them is parsed alone.
std::string_view appended_data(std::string_view bytes, std::string_view& xml) {
  const std::size_t tag = bytes.find(kAppended);
  if (tag == std::string_view::npos) return {};
  const std::size_t close = bytes.find('>', tag);
  if (close == std::string_view::npos) return {};
  xml = bytes.substr(0, close + 1);
  const std::size_t mark = bytes.find_first_not_of(" \t\r\n", close + 1),
                    end = bytes.rfind("</AppendedData>");
  if (mark == std::string_view::npos || bytes[mark] != '_' || end == std::string_view::npos || end <= mark)
    return {};
  return bytes.substr(mark + 1, end - mark - 1);
}

}  // namespace

PolyXml read_poly_xml(const fs::path& path, std::string_view bytes) {
  constexpr std::size_t kBlock = 1 << 24;
  PolyXml xml;
  std::string_view rest = bytes;
  xml.appended = appended_data(bytes, rest);
  const bool whole = rest.size() == bytes.size();
  const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(XML_ParserCreate(nullptr),
                                                                            XML_ParserFree);
  Parsing state{parser.get(), Builder(xml, bytes.size()), {}};
  XML_SetUserData(parser.get(), &state);
  XML_SetElementHandler(parser.get(), on_start, on_end);
  XML_SetCharacterDataHandler(parser.get(), on_characters);
  XML_SetStartDoctypeDeclHandler(parser.get(), on_document_type);
  for (bool more = true; more;) {
    const std::string_view block = rest.substr(0, kBlock);
    rest.remove_prefix(block.size());
    more = !rest.empty();
    const auto status = XML_Parse(parser.get(), block.data(), static_cast<int>(block.size()), whole && !more);
    if (state.complaint) bad_input("{}: {}", path.string(), *state.complaint);
    if (status != XML_STATUS_OK)
      bad_input("{}:{}: found damaged XML ({}), expected a VTK PolyData file (.vtp)", path.string(),
                XML_GetCurrentLineNumber(parser.get()), XML_ErrorString(XML_GetErrorCode(parser.get())));
  }
  if (state.builder.pieces() == 0) bad_input("{}: is no VTK PolyData XML file (.vtp)", path.string());
  return xml;
}

}  // namespace pendular
