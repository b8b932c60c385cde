// Whatever is done to a file of results or a baseline, reading it gives all of it or one sentence.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>

#include "scenes/error.h"
#include "tests/unit/gate_fixture.h"

namespace pb {
namespace {

using Document = nlohmann::ordered_json;
using testing::HasSubstr;

struct FileKind {
  const char* name;
  std::string (*text)();
  void (*read)(const std::string& text);
};

// One cell with every optional part.
Results smallRun() {
  Results run = samples::makeResults();
  run.cells.resize(1);
  run.warnTolerance = {{"relmse", plain(1e-4, 0)}};
  run.sceneTolerances["scene=builtin:a camera=main"] = {{{"relmse", any({plain(1, 0)})}}, {}};
  run.cells[0].cost->ratios = {2.9, 3.0, 3.1};
  run.tolerance.emplace_back(kIntegrityTolerance, plain(1, 0));
  run.cells[0].integrity = {{"probes", 2}};
  return run;
}

const FileKind kKinds[] = {
    {"results", [] { return toJson(smallRun()); }, [](const std::string& text) { resultsFromJson(text, "f.json"); }},
    {"baseline", [] { return toJson(baselineOf(smallRun())); },
     [](const std::string& text) { baselineFromJson(text, "f.json"); }}};

class DamagedFile : public testing::TestWithParam<FileKind> {
 protected:
  // The sentence of the refusal; nullopt if the text was read. Any other exception fails the test.
  std::optional<std::string> refusalOf(const std::string& text) const {
    try {
      GetParam().read(text);
      return std::nullopt;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Failure::input);
      const std::string sentence = error.what();
      EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
      EXPECT_LT(sentence.size(), 400u) << sentence;
      return sentence;
    }
  }

  const std::string text_ = GetParam().text();
};

TEST_P(DamagedFile, CutAnywhere_IsRefused) {
  // Only the line break after the last bracket may be missing.
  for (std::size_t size = 0; size + 1 < text_.size(); size += 1 + size / 40)
    EXPECT_THAT(refusalOf(text_.substr(0, size)).value_or("read"), HasSubstr("f.json")) << size;
  EXPECT_TRUE(refusalOf(text_.substr(0, text_.size() - 2)).has_value());
}

TEST_P(DamagedFile, WithOtherBytes_IsReadWholeOrRefused) {
  for (std::size_t at = 0; at < text_.size(); at += 97)
    for (const char byte : {'\0', '"', '{', '9', '\xff'}) {
      std::string damaged = text_;
      damaged[at] = byte;
      refusalOf(damaged);
    }
}

// The places of all values of a document.
std::vector<Document::json_pointer> placesOf(const Document& document) {
  std::vector<Document::json_pointer> places;
  const std::function<void(const Document&, const Document::json_pointer&)> visit =
      [&](const Document& value, const Document::json_pointer& place) {
        if (!place.empty()) places.push_back(place);
        if (value.is_structured())
          for (const auto& [key, child] : value.items())
            visit(child, value.is_array() ? place / static_cast<std::size_t>(std::stoul(key)) : place / key);
      };
  visit(document, Document::json_pointer());
  return places;
}

TEST_P(DamagedFile, WithAValueOfAnotherType_IsReadWholeOrRefused) {
  const Document document = Document::parse(text_);
  const Document others[] = {nullptr, true, "inf", -1, 1e300, Document::array({1}), Document::object({{"x", 1}})};
  std::size_t number = 0, refused = 0;
  for (const Document::json_pointer& place : placesOf(document)) {
    Document damaged = document;
    damaged[place] = others[number++ % std::size(others)];
    refused += refusalOf(damaged.dump()).has_value() ? 1 : 0;
  }
  EXPECT_GT(refused, number / 2);
}

TEST_P(DamagedFile, WithoutAMember_IsReadWholeOrRefused) {
  const Document document = Document::parse(text_);
  for (const Document::json_pointer& place : placesOf(document)) {
    Document damaged = document;
    Document& parent = damaged[place.parent_pointer()];
    if (parent.is_object())
      parent.erase(place.back());
    else
      parent.erase(parent.begin());
    refusalOf(damaged.dump());
  }
}

TEST_P(DamagedFile, OfAnotherVersion_IsRefusedByItsNumber) {
  const char* key = GetParam().name == std::string("results") ? "schema_version" : "baseline_version";
  for (const int version : {0, 2}) {
    Document document = Document::parse(text_);
    document[key] = version;
    EXPECT_THAT(refusalOf(document.dump()).value_or("read"),
                HasSubstr(fmt::format("has {} {}, this version of probebench reads 1", key, version)));
  }
}

TEST_P(DamagedFile, ThatIsSomethingElse_IsRefusedAsForeign) {
  for (const char* foreign : {"{}", "[]", "3", "null", R"({"version": 1, "cells": []})"})
    EXPECT_THAT(refusalOf(foreign).value_or("read"), HasSubstr(fmt::format("not a probebench {}", GetParam().name)));
  for (const char* text : {"<html>", "cells,1,2", "\xEF\xBB", "\x89PNG\r\n"})
    EXPECT_THAT(refusalOf(text).value_or("read"), testing::AnyOf(HasSubstr("not JSON"), HasSubstr("truncated")));
  EXPECT_THAT(refusalOf(std::string(100'000, '[')).value_or("read"), HasSubstr("levels deep"));
}

INSTANTIATE_TEST_SUITE_P(Files, DamagedFile, testing::ValuesIn(kKinds),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace pb
