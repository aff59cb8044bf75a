#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <unordered_map>
#include <vector>

#include "surface_bins.h"

namespace s2s::map {

/// All columns, in square tiles; the tiles least recently used are in a temporary file, which vanishes with it.
class SurfaceTiles {
 public:
  static constexpr std::int32_t kBits = 5;
  static constexpr std::int32_t kSide = 1 << kBits;
  using Tile = std::array<SurfaceColumn, std::size_t{kSide} * kSide>;

  explicit SurfaceTiles(std::size_t maxInMemory) : maxInMemory_(maxInMemory) {}
  ~SurfaceTiles();
  SurfaceTiles(const SurfaceTiles&) = delete;
  SurfaceTiles& operator=(const SurfaceTiles&) = delete;

  SurfaceColumn& at(std::int32_t column, std::int32_t row);
  /// Every tile with the column and row of its first cell; those put away are read without taking others' place.
  void forEach(const std::function<void(std::int32_t column, std::int32_t row, const Tile&)>& visit) const;

  std::size_t inMemory() const { return inMemory_; }
  std::size_t count() const { return entries_.size(); }

 private:
  struct Entry {
    std::unique_ptr<Tile> tile;  ///< null: in the file
    std::uint64_t lastUse = 0;
    long offset = -1, capacity = 0, bytes = 0;  ///< its place in the file, once it had one
  };
  void putAway(Entry& entry);
  std::unique_ptr<Tile> read(const Entry& entry) const;
  void makeRoom();

  std::size_t maxInMemory_;
  std::unordered_map<std::uint64_t, Entry> entries_;
  std::uint64_t clock_ = 0, lastKey_ = 0;
  Entry* last_ = nullptr;
  std::size_t inMemory_ = 0;
  std::FILE* file_ = nullptr;
};

}  // namespace s2s::map
