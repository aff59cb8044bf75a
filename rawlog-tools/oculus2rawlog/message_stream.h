#pragma once

#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <string_view>

#include "oculus2rawlog/ping_message.h"

namespace s2s::tools::oculus {

/// Splits a sonar's byte stream into messages, reading it piece by piece. Bytes that are no message are passed over
/// until the next header; a message into which the header of another one falls has lost bytes and is given up.
class MessageStream {
 public:
  explicit MessageStream(std::istream& in) : in_(in) {}

  struct Message {
    MessageHeader header;
    std::string_view bytes;  ///< header included; valid until the next call
    std::uint64_t at = 0;    ///< offset in the stream
  };
  std::optional<Message> next();

  std::uint64_t garbageBytes() const { return garbageBytes_; }  ///< passed over in all
  std::uint64_t cutMessages() const { return cutMessages_; }    ///< messages that lost bytes, or end with the stream
  /// Where the first of them is.
  std::uint64_t firstGarbageAt() const { return firstGarbageAt_; }
  std::uint64_t bytesRead() const { return begin_ + position_; }

 private:
  /// Makes `count` bytes from the position on available; false if the stream ends before.
  bool ensure(std::size_t count);
  std::string_view rest() const { return std::string_view(buffer_).substr(position_); }
  void passOver();

  std::istream& in_;
  std::string buffer_;
  std::size_t position_ = 0;  ///< in the buffer
  std::uint64_t begin_ = 0;   ///< offset of the buffer in the stream
  std::uint64_t garbageBytes_ = 0, cutMessages_ = 0, firstGarbageAt_ = 0;
};

}  // namespace s2s::tools::oculus
