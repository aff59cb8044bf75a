#include "s2s/sim/ping_truth.h"

#include "s2s/core/error.h"

namespace s2s::sim {

namespace {

constexpr char kMagic[] = "S2S-RETURNS 1\n";

}  // namespace

PingTruthWriter::PingTruthWriter(const std::string& path) : file_(path) { file_.stream() << kMagic; }

void PingTruthWriter::write(const PingTruth& ping) {
  std::ofstream& out = file_.stream();
  const auto count = static_cast<std::uint32_t>(ping.returns.size());
  out.write(reinterpret_cast<const char*>(&ping.time), sizeof ping.time);
  out.write(reinterpret_cast<const char*>(&ping.pingId), sizeof ping.pingId);
  out.write(reinterpret_cast<const char*>(&count), sizeof count);
  out.write(reinterpret_cast<const char*>(ping.returns.data()),
            static_cast<std::streamsize>(count * sizeof(StrongReturn)));
}

void PingTruthWriter::close() { file_.commit(); }

PingTruthReader::PingTruthReader(const std::string& path) : path_(path), in_(path, std::ios::binary) {
  std::string line;
  if (!in_ || !std::getline(in_, line) || line + "\n" != kMagic)
    throw core::InputError("this is no file of true sonar returns", path, "give a returns_*.bin of simulate-survey");
}

bool PingTruthReader::next(PingTruth& ping) {
  std::uint32_t count = 0;
  if (!in_.read(reinterpret_cast<char*>(&ping.time), sizeof ping.time)) {
    if (in_.gcount() == 0) return false;
  }
  in_.read(reinterpret_cast<char*>(&ping.pingId), sizeof ping.pingId);
  in_.read(reinterpret_cast<char*>(&count), sizeof count);
  constexpr std::uint32_t kMaxBeams = 65536;
  if (in_ && count <= kMaxBeams) {
    ping.returns.resize(count);
    in_.read(reinterpret_cast<char*>(ping.returns.data()), static_cast<std::streamsize>(count * sizeof(StrongReturn)));
  }
  if (!in_ || count > kMaxBeams)
    throw core::InputError("the file of true sonar returns is cut or damaged", path_, "simulate again");
  return true;
}

}  // namespace s2s::sim
