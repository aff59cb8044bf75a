#pragma once

#include <stdexcept>
#include <string>

namespace s2s::core {

/// Base of the errors a user can cause and cure: it says what is wrong, where, and what to do.
///
/// Broken invariants inside the program are not such errors; they use MRPT's assertions.
class Error : public std::runtime_error {
 public:
  /// @param what   the fault, one sentence without a full stop
  /// @param where  file, record number, byte, time, section and key: all that is known; may be empty
  /// @param remedy what the user can do about it; may be empty
  Error(const std::string& what, const std::string& where, const std::string& remedy);

  const std::string& fault() const { return fault_; }
  const std::string& where() const { return where_; }
  const std::string& remedy() const { return remedy_; }

 private:
  std::string fault_, where_, remedy_;
};

/// Data that cannot be used: missing, unreadable, damaged or of the wrong kind. Programs exit with 3.
class InputError : public Error {
 public:
  using Error::Error;
};

/// A wrong option, key, section or value. Programs exit with 2.
class ConfigError : public Error {
 public:
  using Error::Error;
};

/// An output that cannot be written. Programs exit with 4.
class OutputError : public Error {
 public:
  using Error::Error;
};

}  // namespace s2s::core
