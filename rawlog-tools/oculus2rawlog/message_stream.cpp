#include "oculus2rawlog/message_stream.h"

#include <algorithm>

namespace s2s::tools::oculus {

namespace {

constexpr std::size_t kChunk = 1u << 20;

/// True if the header of another message begins within the payload of the one at the beginning of `bytes`.
bool containsHeader(std::string_view bytes, const MessageHeader& own) {
  for (std::size_t at = bytes.find("SO", MessageHeader::kBytes); at < own.messageBytes();
       at = bytes.find("SO", at + 1)) {
    const auto header = parseHeader(bytes.substr(at));
    // Echo strengths can spell a header by chance, but hardly one between the same two devices.
    if (header && header->source == own.source && header->destination == own.destination) return true;
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
    ensure(header->messageBytes() + MessageHeader::kBytes - 1);  // a header may begin within and end behind it
    if (!whole || containsHeader(rest(), *header)) {
      ++cutMessages_;
      passOver();
      continue;
    }
    const Message message{*header, rest().substr(0, header->messageBytes()), bytesRead()};
    position_ += header->messageBytes();
    return message;
  }
  while (!rest().empty()) passOver();
  return std::nullopt;
}

}  // namespace s2s::tools::oculus
