#include "s2s/core/error.h"

namespace s2s::core {

namespace {

std::string fullText(const std::string& what, const std::string& where, const std::string& remedy) {
  std::string text = what;
  if (!where.empty()) text += "\n  where: " + where;
  if (!remedy.empty()) text += "\n  what to do: " + remedy;
  return text;
}

}  // namespace

Error::Error(const std::string& what, const std::string& where, const std::string& remedy)
    : std::runtime_error(fullText(what, where, remedy)), fault_(what), where_(where), remedy_(remedy) {}

}  // namespace s2s::core
