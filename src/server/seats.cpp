// SPDX-License-Identifier: MIT
#include "server/seats.h"

#include <algorithm>

namespace dynslam {
namespace {

constexpr std::size_t kKeptForStop = 2;

}  // namespace

Seats::Id Seats::open(const std::string& address, SteadyTime now) {
  std::size_t& share = per_address_[address];
  if (share >= limits_.per_address) {
    ++refused_;
    return 0;
  }
  ++share;
  guests_[++last_] = {address, Use::kNothing, now};
  return last_;
}

bool Seats::use(Id id, Use use, SteadyTime now) {
  const auto found = guests_.find(id);
  if (found == guests_.end()) return false;
  Guest& guest = found->second;
  if (guest.use == Use::kNothing) ++busy_;
  const std::size_t kept = use == Use::kStop ? 0 : use == Use::kControl ? kKeptForStop : limits_.kept;
  const bool has_seat = free(busy_) >= kept;
  if (!has_seat) ++refused_;
  guest.use = has_seat ? use : Use::kRequest;  // to be told so, in short
  guest.since = now;
  return has_seat;
}

void Seats::close(Id id) {
  const auto found = guests_.find(id);
  if (found == guests_.end()) return;
  if (found->second.use != Use::kNothing) --busy_;
  const auto share = per_address_.find(found->second.address);
  if (--share->second == 0) per_address_.erase(share);
  guests_.erase(found);
}

std::vector<Seats::Id> Seats::overdue(SteadyTime now, const std::function<bool(Id)>& is_heard) const {
  std::vector<Id> cut;
  std::size_t missing = limits_.kept - std::min(limits_.kept, free(guests_.size()));
  for (const auto& [id, guest] : guests_) {
    const auto waited = now - guest.since;
    const bool asks = guest.use == Use::kRequest || guest.use == Use::kStop;
    const bool idle = guest.use == Use::kNothing;
    const bool in_the_way = idle && missing > 0 && waited >= kGrace && is_heard(id);
    if (!in_the_way && !(idle && waited > kPatience) && !(asks && waited > kLongestAnswer)) continue;
    cut.push_back(id);
    missing -= std::min<std::size_t>(missing, 1);
  }
  return cut;
}

}  // namespace dynslam
