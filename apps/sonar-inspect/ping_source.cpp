#include "ping_source.h"

#include <cmath>
#include <map>

#include "s2s/core/error.h"
#include "s2s/core/time.h"
#include "s2s/obs/rawlog_reader.h"

namespace s2s::inspect {

namespace {

using Ping = obs::CObservationImagingSonar;

Ping::Ptr nextPing(obs::RawlogReader& reader) {
  while (const auto observation = reader.next())
    if (auto ping = std::dynamic_pointer_cast<Ping>(observation)) return ping;
  return nullptr;
}

/// How many pings each sonar has.
std::map<std::string, std::size_t> countPings(const std::string& rawlog) {
  std::map<std::string, std::size_t> counts;
  obs::RawlogReader reader(rawlog);
  while (const auto ping = nextPing(reader)) ++counts[ping->sensorLabel];
  return counts;
}

double secondsApart(const Ping& a, const Ping& b) {
  return std::abs(core::secondsBetween(core::fromMrptTime(a.timestamp), core::fromMrptTime(b.timestamp)));
}

}  // namespace

PingPair readPings(const std::string& rawlog, const PingLabels& labels, std::size_t index) {
  const auto counts = countPings(rawlog);
  if (counts.empty())
    throw core::InputError("the log holds no ping of an imaging sonar", rawlog, "give a log with sonar data");
  const bool both = counts.count(labels.horizontal) != 0;
  const std::string label = both ? labels.horizontal : counts.begin()->first;
  if (index >= counts.at(label))
    throw core::InputError("there is no ping number " + std::to_string(index) + " of " + label, rawlog,
                           "give --ping 0 to " + std::to_string(counts.at(label) - 1));

  Ping::Ptr chosen, partner, lastOther;
  obs::RawlogReader reader(rawlog);
  for (std::size_t seen = 0; const auto ping = nextPing(reader);) {
    if (ping->sensorLabel == label && seen++ == index) {
      chosen = ping;
      partner = lastOther;
    } else if (ping->sensorLabel == labels.vertical && label != labels.vertical) {
      lastOther = ping;
      if (!chosen) continue;
      if (!partner || secondsApart(*ping, *chosen) < secondsApart(*partner, *chosen)) partner = ping;
      break;
    }
  }
  return label == labels.vertical ? PingPair{nullptr, chosen} : PingPair{chosen, partner};
}

}  // namespace s2s::inspect
