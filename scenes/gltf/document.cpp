#include "scenes/gltf/document.h"

#include <charconv>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <utility>

#include "scenes/error.h"
#include "scenes/files.h"
#include "scenes/gltf/validate.h"

namespace pb::gltf {
namespace {

using nlohmann::json;

constexpr std::string_view kGlbMagic = "glTF";
constexpr std::size_t kGlbHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
// No glTF member nests deeper than 8; parsers recurse, so that deeper text could exhaust the stack.
constexpr int kMaxJsonDepth = 64;

// A JSON text and the binary chunk of a .glb, both inside the file's bytes.
struct Container {
  std::string_view jsonText;
  std::string_view binary;
};

std::uint32_t littleEndian32(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = (value << 8) | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

void appendLittleEndian32(std::string& bytes, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>((value >> shift) & 0xff);
}

// glTF 2.0, section 4.4.
Container splitGlb(std::string_view bytes) {
  if (bytes.size() < kGlbHeaderBytes + kChunkHeaderBytes)
    throwInputError("a .glb has at least {} bytes, the file has {}", kGlbHeaderBytes + kChunkHeaderBytes, bytes.size());
  if (const std::uint32_t version = littleEndian32(bytes, 4); version != 2)
    throwInputError("glTF 2.0 is read, the .glb header's version is {}", version);
  const std::size_t length = littleEndian32(bytes, 8);
  if (length > bytes.size()) throwInputError("the .glb is truncated: {} of {} bytes", bytes.size(), length);
  Container container;
  std::size_t at = kGlbHeaderBytes;
  while (at + kChunkHeaderBytes <= length) {
    const std::size_t chunkLength = littleEndian32(bytes, at);
    const std::uint32_t type = littleEndian32(bytes, at + 4);
    at += kChunkHeaderBytes;
    if (chunkLength > length - at) throwInputError("a .glb chunk of {} bytes ends beyond the file", chunkLength);
    if (type == kJsonChunk && container.jsonText.empty()) container.jsonText = bytes.substr(at, chunkLength);
    if (type == kBinaryChunk && container.binary.empty()) container.binary = bytes.substr(at, chunkLength);
    at += chunkLength;
  }
  if (container.jsonText.empty()) throwInputError("the .glb has no JSON chunk");
  return container;
}

// Without the parser's own error code in brackets before the message, and the file's bytes after it.
std::string essenceOf(const std::string& message) {
  const std::size_t codeEnd = message.find("] ");
  const std::size_t start = codeEnd == std::string::npos ? 0 : codeEnd + 2;
  return message.substr(start, message.find("; last read") - start);
}

json parseJson(std::string_view text) {
  const auto refuseDeepNesting = [](int depth, json::parse_event_t, json&) {
    if (depth > kMaxJsonDepth) throwInputError("the JSON nests deeper than {} levels", kMaxJsonDepth);
    return true;
  };
  try {
    return json::parse(text, refuseDeepNesting);
  } catch (const json::exception& e) {
    throwInputError("a glTF file is wanted, its JSON can't be parsed: {}", essenceOf(e.what()));
  }
}

bool fileExists(const std::string& path, void*) {
  // tinygltf looks in the working directory too, by a relative path; a scene must not depend on that.
  std::error_code ignored;
  return std::filesystem::path(path).is_absolute() && std::filesystem::is_regular_file(path, ignored);
}

std::string unexpandedPath(const std::string& path, void*) { return path; }

bool readWholeFile(std::vector<unsigned char>* out, std::string* error, const std::string& path, void*) {
  try {
    const std::string bytes = readFile(path);
    out->assign(bytes.begin(), bytes.end());
    return true;
  } catch (const Error& e) {
    *error = e.what();
    return false;
  }
}

std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

tinygltf::Model parseModel(const std::string& glb, const std::string& folder) {
  tinygltf::TinyGLTF parser;
  parser.SetFsCallbacks({fileExists, unexpandedPath, readWholeFile, nullptr, nullptr});
  tinygltf::Model model;
  std::string error, warning;
  const bool parsed =
      parser.LoadBinaryFromMemory(&model, &error, &warning, reinterpret_cast<const unsigned char*>(glb.data()),
                                  static_cast<unsigned>(glb.size()), folder, tinygltf::NO_REQUIRE);
  if (!parsed) throwInputError("the file can't be read: {}", error.empty() ? "it is damaged" : firstLine(error));
  return model;
}

// What tinygltf is given: images are read by imageBytes(), and the index accessors of Draco primitives have no data.
json withoutImagesAndDracoIndices(json document) {
  document.erase("images");
  if (!document.contains("meshes")) return document;
  for (json& mesh : document["meshes"]) {
    if (!mesh.contains("primitives")) continue;
    for (json& primitive : mesh["primitives"])
      if (primitive.contains("/extensions/KHR_draco_mesh_compression"_json_pointer)) primitive.erase("indices");
  }
  return document;
}

void checkBuffersHaveData(const json& document, std::string_view binary) {
  const json buffers = document.value("buffers", json::array());
  for (std::size_t i = 0; i < buffers.size(); ++i)
    if (!buffers[i].contains("uri") && (i > 0 || buffers[i]["byteLength"] > binary.size()))
      throwInputError("buffers/{} wants {} bytes, the file's binary chunk has {}", i, buffers[i]["byteLength"].dump(),
                      i > 0 ? 0 : binary.size());
}

void checkBufferViews(const tinygltf::Model& model) {
  for (std::size_t i = 0; i < model.bufferViews.size(); ++i) {
    const tinygltf::BufferView& view = model.bufferViews[i];
    const std::size_t size = model.buffers.at(static_cast<std::size_t>(view.buffer)).data.size();
    if (view.byteOffset > size || view.byteLength > size - view.byteOffset)
      throwInputError("bufferViews/{} wants bytes {} to {} of a buffer of {}", i, view.byteOffset,
                      view.byteOffset + view.byteLength, size);
  }
}

std::string percentDecoded(std::string_view uri) {
  std::string path;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned value = 0;
    const bool escaped = uri[i] == '%' && i + 2 < uri.size() &&
                         std::from_chars(&uri[i + 1], &uri[i + 1] + 2, value, 16).ptr == &uri[i + 1] + 2;
    path += escaped ? static_cast<char>(value) : uri[i];
    if (escaped) i += 2;
  }
  return path;
}

std::string dataUriBytes(const std::string& uri, int image) {
  std::vector<unsigned char> bytes;
  std::string mimeType;
  if (!tinygltf::DecodeDataURI(&bytes, mimeType, uri, 0, false))
    throwInputError("images/{}/uri wants base64 image data, got '{}..'", image, uri.substr(0, 40));
  return {bytes.begin(), bytes.end()};
}

}  // namespace

Document parseDocument(const std::string& bytes, const std::string& folder) {
  if (bytes.empty()) throwInputError("the file is empty");
  const bool isGlb = bytes.starts_with(kGlbMagic);
  const Container container = isGlb ? splitGlb(bytes) : Container{bytes, {}};
  Document document;
  document.json = parseJson(container.jsonText);
  checkRequirements(document.json);
  validate(document.json);
  checkBuffersHaveData(document.json, container.binary);
  document.folder = folder;
  document.model = parseModel(packGlb(withoutImagesAndDracoIndices(document.json), container.binary), document.folder);
  checkBufferViews(document.model);
  return document;
}

std::span<const std::byte> bytesOf(const Document& document, int bufferView) {
  const tinygltf::BufferView& view = document.model.bufferViews.at(static_cast<std::size_t>(bufferView));
  const std::vector<unsigned char>& data = document.model.buffers.at(static_cast<std::size_t>(view.buffer)).data;
  return std::as_bytes(std::span(data)).subspan(view.byteOffset, view.byteLength);
}

std::string imageBytes(const Document& document, int index) {
  const json& image = document.json.at("images").at(static_cast<std::size_t>(index));
  if (image.contains("bufferView")) {
    const std::span<const std::byte> bytes = bytesOf(document, image["bufferView"]);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  if (!image.contains("uri")) throwInputError("images/{} wants a uri or a bufferView", index);
  const std::string uri = image["uri"];
  if (tinygltf::IsDataURI(uri)) return dataUriBytes(uri, index);
  return readFile((std::filesystem::path(document.folder) / percentDecoded(uri)).string());
}

std::string label(const std::string& name, std::size_t index) {
  return name.empty() ? std::to_string(index) : "'" + name + "'";
}

std::string packGlb(const json& document, std::string_view binary) {
  const auto padded = [](std::string_view bytes, char filler) {
    std::string result(bytes);
    result.resize((bytes.size() + 3) / 4 * 4, filler);
    return result;
  };
  const std::string jsonText = padded(document.dump(), ' ');
  const std::string data = padded(binary, '\0');
  const std::size_t length =
      kGlbHeaderBytes + kChunkHeaderBytes + jsonText.size() + (data.empty() ? 0 : kChunkHeaderBytes + data.size());
  if (length > std::numeric_limits<std::uint32_t>::max())
    throwInputError("a .glb has at most 4 GiB, this one would have {} bytes", length);
  std::string glb(kGlbMagic);
  appendLittleEndian32(glb, 2);
  appendLittleEndian32(glb, length);
  appendLittleEndian32(glb, jsonText.size());
  appendLittleEndian32(glb, kJsonChunk);
  glb += jsonText;
  if (data.empty()) return glb;
  appendLittleEndian32(glb, data.size());
  appendLittleEndian32(glb, kBinaryChunk);
  return glb + data;
}

}  // namespace pb::gltf
