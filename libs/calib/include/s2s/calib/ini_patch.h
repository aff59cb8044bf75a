#pragma once

#include <string>

namespace s2s::calib {

/// Sets a key in the text of an INI file and leaves all else as it is: comments, order, blanks. A key that is missing
/// is added at the end of its section, a section that is missing at the end of the file.
std::string patchedIni(const std::string& text, const std::string& section, const std::string& key,
                       const std::string& value);

}  // namespace s2s::calib
