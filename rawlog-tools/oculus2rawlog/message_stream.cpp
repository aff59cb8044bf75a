#include "oculus2rawlog/message_stream.h"

#include <algorithm>

namespace s2s::tools::oculus {

namespace {

constexpr std::size_t kChunk = 1u << 20;

/// True if the header of another message stands within the payload.
bool containsHeader(std::string_view message) {
  for (std::size_t at = message.find("SO", MessageHeader::kBytes); at != std::string_view::npos;
       at = message.find("SO", at + 1)) {
    const auto header = parseHeader(message.substr(at));
    // Echo strengths can spell a header by chance, but hardly one between the same two devices.
    const auto own = parseHeader(message);
    if (header && header->source == own->source && header->destination == own->destination) return true;
  }
  return false;
}

}  // namespace

bool MessageStream::ensure(std::size_t count) {
  while (buffer_.size() - position_ < count && in_) {
    if (position_ > kChunk) {
      begin_ += position_;
      buffer_.erase(0, position_);
      position_ = 0;
    }
    const std::size_t before = buffer_.size();
    buffer_.resize(before + kChunk);
    in_.read(buffer_.data() + before, static_cast<std::streamsize>(kChunk));
    buffer_.resize(before + static_cast<std::size_t>(std::max<std::streamsize>(in_.gcount(), 0)));
  }
  return buffer_.size() - position_ >= count;
}

void MessageStream::passOver() {
  if (garbageBytes_ == 0) firstGarbageAt_ = bytesRead();
  ++garbageBytes_;
  ++position_;
}

std::optional<MessageStream::Message> MessageStream::next() {
  while (ensure(MessageHeader::kBytes)) {
    const auto header = parseHeader(rest());
    if (!header) {
      passOver();
      continue;
    }
    const bool whole = ensure(header->messageBytes());
    const auto bytes = rest().substr(0, header->messageBytes());
    if (!whole || containsHeader(bytes)) {
      ++cutMessages_;
      passOver();
      continue;
    }
    const Message message{*header, bytes, bytesRead()};
    position_ += bytes.size();
    return message;
  }
  while (!rest().empty()) passOver();
  return std::nullopt;
}

}  // namespace s2s::tools::oculus
