#include "surface_tiles.h"

#include <algorithm>
#include <cstring>

#include "s2s/core/error.h"

namespace s2s::map {

namespace {

/// So much of the tiles in memory is put away at once: looking for the oldest takes a pass over all of them.
constexpr double kShareToPutAway = 0.25;

template <class Number>
void append(std::vector<char>& bytes, const Number& number) {
  const auto* raw = reinterpret_cast<const char*>(&number);
  bytes.insert(bytes.end(), raw, raw + sizeof number);
}

template <class Number>
Number take(const char*& at) {
  Number number{};
  std::memcpy(&number, at, sizeof number);
  at += sizeof number;
  return number;
}

std::uint64_t keyOf(std::int32_t tileColumn, std::int32_t tileRow) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(tileColumn)) << 32 | static_cast<std::uint32_t>(tileRow);
}

[[noreturn]] void failed(const char* what) {
  throw core::OutputError(std::string("tiles of the estimated surface cannot be ") + what, "temporary file",
                          "make room on the disk of the folder for temporary files (TMPDIR), or raise max_tiles");
}

}  // namespace

SurfaceTiles::~SurfaceTiles() {
  if (file_) std::fclose(file_);
}

SurfaceColumn& SurfaceTiles::at(std::int32_t column, std::int32_t row) {
  constexpr std::int32_t kMask = kSide - 1;
  const std::uint64_t key = keyOf(column >> kBits, row >> kBits);
  if (!last_ || key != lastKey_ || !last_->tile) {
    Entry& entry = entries_[key];
    if (!entry.tile) {
      if (inMemory_ >= maxInMemory_) makeRoom();
      entry.tile = entry.bytes > 0 ? read(entry) : std::make_unique<Tile>();
      ++inMemory_;
    }
    last_ = &entry;  // references into an unordered_map stay good
    lastKey_ = key;
  }
  last_->lastUse = ++clock_;
  return (*last_->tile)[static_cast<std::size_t>(row & kMask) * std::size_t{kSide} +
                        static_cast<std::size_t>(column & kMask)];
}

void SurfaceTiles::forEach(const std::function<void(std::int32_t, std::int32_t, const Tile&)>& visit) const {
  for (const auto& [key, entry] : entries_) {
    const auto column = static_cast<std::int32_t>(key >> 32) * kSide;
    const auto row = static_cast<std::int32_t>(key & 0xffffffffU) * kSide;
    if (entry.tile)
      visit(column, row, *entry.tile);
    else if (entry.bytes > 0)
      visit(column, row, *read(entry));
  }
}

void SurfaceTiles::makeRoom() {
  std::vector<Entry*> present;
  for (auto& [key, entry] : entries_)
    if (entry.tile) present.push_back(&entry);
  const auto few = std::max<std::size_t>(1, static_cast<std::size_t>(kShareToPutAway * present.size()));
  std::nth_element(present.begin(), present.begin() + static_cast<std::ptrdiff_t>(few - 1), present.end(),
                   [](const Entry* a, const Entry* b) { return a->lastUse < b->lastUse; });
  for (std::size_t i = 0; i < few; ++i) putAway(*present[i]);
}

void SurfaceTiles::putAway(Entry& entry) {
  std::vector<char> bytes;
  for (const SurfaceColumn& column : *entry.tile) {
    append(bytes, static_cast<std::uint32_t>(column.bins.size()));
    if (column.bins.empty()) continue;
    append(bytes, column.pings);
    append(bytes, column.lastAdded);
    append(bytes, column.lastRemoved);
    for (const SurfaceBin& bin : column.bins) append(bytes, bin);
  }
  if (!file_ && !(file_ = std::tmpfile())) failed("put away");
  const auto size = static_cast<long>(bytes.size());
  const bool fits = entry.offset >= 0 && size <= entry.capacity;
  if (std::fseek(file_, fits ? entry.offset : 0, fits ? SEEK_SET : SEEK_END) != 0) failed("put away");
  if (!fits) {
    entry.offset = std::ftell(file_);
    entry.capacity = size + size / 2;  // most tiles come back and grow
    bytes.resize(static_cast<std::size_t>(entry.capacity));
  }
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) failed("put away");
  entry.bytes = size;
  entry.tile.reset();
  --inMemory_;
}

std::unique_ptr<SurfaceTiles::Tile> SurfaceTiles::read(const Entry& entry) const {
  std::vector<char> bytes(static_cast<std::size_t>(entry.bytes));
  if (std::fseek(file_, entry.offset, SEEK_SET) != 0 ||
      std::fread(bytes.data(), 1, bytes.size(), file_) != bytes.size())
    failed("read back");
  auto tile = std::make_unique<Tile>();
  const char* at = bytes.data();
  for (SurfaceColumn& column : *tile) {
    const auto bins = take<std::uint32_t>(at);
    if (bins == 0) continue;
    column.pings = take<std::uint32_t>(at);
    column.lastAdded = take<core::TimeNs>(at);
    column.lastRemoved = take<core::TimeNs>(at);
    for (std::uint32_t i = 0; i < bins; ++i) column.bins.push_back(take<SurfaceBin>(at));
  }
  return tile;
}

}  // namespace s2s::map
