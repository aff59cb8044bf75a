#include "s2s/core/atomic_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "s2s/core/error.h"

namespace s2s::core {

namespace fs = std::filesystem;

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
  const fs::path target(path_);
  if (target.has_parent_path()) {
    std::error_code error;
    fs::create_directories(target.parent_path(), error);
    if (error)
      throw OutputError("cannot make the folder: " + error.message(), target.parent_path().string(),
                        "choose an output folder you may write to");
  }
  temporary_ = (target.parent_path() / ("." + target.stem().string() + "." + std::to_string(::getpid()) + ".part" +
                                        target.extension().string()))
                   .string();
}

AtomicFile::~AtomicFile() {
  if (committed_) return;
  stream_.close();
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

std::ofstream& AtomicFile::stream() {
  if (!stream_.is_open()) {
    stream_.open(temporary_, std::ios::binary | std::ios::trunc);
    if (!stream_)
      throw OutputError(std::string("cannot open the file for writing: ") + std::strerror(errno), path_,
                        "choose an output folder you may write to");
  }
  return stream_;
}

void AtomicFile::commit() {
  if (stream_.is_open()) {
    stream_.close();
    if (!stream_) throw OutputError("writing failed", path_, "check that the disk has room");
  }
  std::error_code error;
  fs::rename(temporary_, path_, error);
  if (error) throw OutputError("cannot name the finished file: " + error.message(), path_, "check the output folder");
  committed_ = true;
}

void writeTextFile(const std::string& path, const std::string& text) {
  AtomicFile file(path);
  file.stream() << text;
  file.commit();
}

}  // namespace s2s::core
