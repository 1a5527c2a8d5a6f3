#include "base/yaml_text.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <set>
#include <sstream>

#include "base/error.hpp"
#include "base/yaml_document.hpp"

namespace abut {
namespace {

constexpr int max_depth = 64;  // no honest scene comes near

/// Counts what a text holds before a tree is made of it, and refuses what a tree would not show:
/// tags, which change nothing here, and characters at which the library stands still.
class Census final : public YAML::EventHandler {
 public:
  explicit Census(const std::string& name) : name_(name) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    // At a character that begins nothing, such as a lone comma, documents follow each other for
    // ever.
    if (documents_ > 0 && mark.pos == begin_)
      throw InputError("is not readable as YAML: nothing can begin with this character",
                       at_line(name_, mark), "Correct the line, or take the character out.");
    begin_ = mark.pos;
    if (++documents_ == 2) second_ = mark;
    if (documents_ > 2) refuse_documents();
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { count(mark); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { count(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                const std::string&) override {
    count(mark);
    refuse_tag(mark, tag);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    enter(mark, tag);
  }
  void OnSequenceEnd() override { --depth_; }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    enter(mark, tag);
  }
  void OnMapEnd() override { --depth_; }

  void refuse_second_document() const {
    if (documents_ > 1) refuse_documents();
  }

 private:
  void enter(const YAML::Mark& mark, const std::string& tag) {
    count(mark);
    refuse_tag(mark, tag);
    if (++depth_ > max_depth)
      throw InputError(fmt::format("is nested more than {} deep", max_depth), at_line(name_, mark),
                       "Write maps and lists as the reference shows them.");
  }
  void count(const YAML::Mark& mark) {
    if (++values_ > max_values)
      throw InputError(fmt::format("holds more than {} values", max_values), at_line(name_, mark),
                       "Give large data in files of their own, such as meshes.");
  }
  /// "?" stands for no tag, and "!" for quotes.
  void refuse_tag(const YAML::Mark& mark, const std::string& tag) const {
    if (tag.empty() || tag == "?" || tag == "!") return;
    throw InputError(fmt::format("has the tag {}, which means nothing here", tag),
                     at_line(name_, mark),
                     "Take the tag out; units are not written: the reference names them.");
  }
  [[noreturn]] void refuse_documents() const {
    throw InputError("holds a second document", at_line(name_, second_),
                     "Write one scene per file, without --- lines between its parts.");
  }

  const std::string& name_;
  int documents_ = 0, depth_ = 0;
  std::size_t values_ = 0;
  int begin_ = -1;  // of the last document, in characters
  YAML::Mark second_;
};

/// Looks in the tree for what YAML allows and a scene does not: duplicate keys, keys that are no
/// plain words, and aliases that repeat each other without bound.
class FormCheck {
 public:
  explicit FormCheck(const std::string& name) : name_(name) {}

  void visit(const YAML::Node& node, const std::string& path, int depth) {
    if (depth > max_depth || ++nodes_ > max_values)
      throw InputError("holds too many values", name_, "Remove anchors that repeat themselves.");
    if (node.IsSequence()) {
      std::size_t i = 0;
      for (const YAML::Node& item : node) visit(item, fmt::format("{}[{}]", path, i++), depth + 1);
    }
    if (node.IsMap()) visit_map(node, path, depth);
  }

 private:
  void visit_map(const YAML::Node& node, const std::string& path, int depth) {
    std::set<std::string> seen;
    for (const auto& pair : node) {
      const std::string where = at_line(name_, pair.first.Mark());
      if (!pair.first.IsScalar())
        throw InputError("has a key that is not a word", where, "Write keys as plain words.");
      const std::string key_path = join_path(path, pair.first.Scalar());
      if (!seen.insert(pair.first.Scalar()).second)
        throw InputError("is given twice", where + ": " + key_path, "Remove one of the two.");
      visit(pair.second, key_path, depth + 1);
    }
  }

  const std::string& name_;
  std::size_t nodes_ = 0;
};

}  // namespace

std::string at_line(const std::string& name, const YAML::Mark& mark) {
  return mark.line < 0 ? name : fmt::format("{}:{}", name, mark.line + 1);
}

YAML::Node parse_yaml(const std::string& text, const std::string& name, const std::string& path,
                      const std::string& remedy) {
  YAML::Node root;
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    Census census(name);
    while (parser.HandleNextDocument(census)) {
    }
    census.refuse_second_document();
    root.reset(YAML::Load(text));
  } catch (const YAML::Exception& error) {
    throw InputError("is not readable as YAML: " + error.msg, at_line(name, error.mark), remedy);
  }
  FormCheck(name).visit(root, path, 0);
  return root;
}

}  // namespace abut
