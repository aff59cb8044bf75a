#pragma once

#include <fstream>
#include <string>

namespace s2s::core {

/// A file that appears under its name only when it is complete: written beside it, renamed by `commit`.
class AtomicFile {
 public:
  /// Makes the parent folders when they are missing.
  /// @throws OutputError if the folder cannot be made
  explicit AtomicFile(std::string path);
  /// Removes the temporary file if `commit` was not reached.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Where to write until `commit`; for libraries that open files by name. It keeps the extension of the final name.
  const std::string& temporaryPath() const { return temporary_; }

  /// A binary stream onto the temporary file, opened at the first call.
  /// @throws OutputError if it cannot be opened
  std::ofstream& stream();

  /// Closes the stream and gives the file its name.
  /// @throws OutputError if writing failed or the file cannot be renamed
  void commit();

 private:
  std::string path_, temporary_;
  std::ofstream stream_;
  bool committed_ = false;
};

/// Writes a whole text file through an AtomicFile.
/// @throws OutputError
void writeTextFile(const std::string& path, const std::string& text);

}  // namespace s2s::core
