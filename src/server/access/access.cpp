// SPDX-License-Identifier: MIT
#include "server/access/access.h"

#include <mutex>
#include <utility>

#include "base/error.h"
#include "io/state_file.h"
#include "server/access/back_off.h"
#include "server/access/credential_book.h"
#include "server/access/way_in.h"

namespace dynslam {
namespace {

using Kind = Credential::Kind;

constexpr std::chrono::hours kOwnerCodeLasts{24};
constexpr std::chrono::minutes kSaveSeenEvery{10};  // spares the SD card
constexpr const char* kCookieAttributes = "; Path=/; HttpOnly; SameSite=Strict";
constexpr int kCookieLasts_s = 400 * 24 * 3600;  // the most that browsers allow; the robot knows when it ends

std::string cookie(const std::string& value, int lasts_s) {
  return kSessionCookie + ('=' + value) + kCookieAttributes + "; Max-Age=" + std::to_string(lasts_s);
}

std::string article(Role role) {
  return (role == Role::kAdmin ? "an " : "a ") + std::string(to_string(role));
}

AccessConfig checked(const AccessConfig& config) {
  if (const auto problem = config.problem()) throw InputError(*problem);
  return config;
}

/// What a request shows of credentials. A token that is shown alone counts; so a program's mistake shows.
struct Shown {
  explicit Shown(const AccessRequest& request) {
    if (const auto bearer = request.authorization ? bearer_of(*request.authorization) : std::nullopt) {
      kind = Kind::kToken;
      add(*bearer);
    } else if (request.cookie) {
      for (const std::string_view value : cookies_named(*request.cookie, kSessionCookie)) add(value);
    }
  }
  void add(std::string_view secret) {
    any = true;
    if (is_secret(secret)) digests.push_back(digest_of(secret));
  }

  Kind kind = Kind::kSession;
  bool any = false;
  std::vector<Digest> digests;
};

Judgement refused(int status, std::string why) { return {status, std::move(why), Role::kNone, {}, {}}; }

Admission no_admission(int status, std::string why, int retry_after_s = 0) {
  return {status, std::move(why), retry_after_s, {}, {}, {}};
}

}  // namespace

/// Locks `saving` before `mutex`; the latter is held for short only.
struct Access::State {
  explicit State(AccessSetup setup)
      : config(checked(setup.config)),
        trust_loopback(setup.trust_loopback),
        way_in(config, setup.host_name),
        book(std::chrono::days(config.session_days)) {
    way_in.set_addresses(setup.addresses);
    if (setup.folder) load(*setup.folder);
  }

  void load(const std::string& folder);
  using Check = std::optional<WayIn::Refusal> (WayIn::*)(const AccessRequest&) const;
  Judgement judge(const AccessRequest& request, Role needed, const AccessTime& now, Check check);
  Judgement identify(const AccessRequest& request, const Shown& shown, const AccessTime& now);
  AccessTime follow_clock(const AccessTime& now);
  Admission take(const std::string& typed, const std::string& address, const AccessTime& now,
                 PairingCode& code);
  Admission admit(Kind kind, const std::string& name, Role role, const AccessTime& now);
  /// What went wrong; empty when nothing did.
  std::string save();

  const AccessConfig config;
  const bool trust_loopback;
  std::mutex saving;
  std::optional<StateFile> file;  ///< by `saving`
  std::string notice;             ///< of the state that was read

  mutable std::mutex mutex;  ///< of all that follows
  WayIn way_in;
  BackOff back_off;
  PairingCodes codes;
  CredentialBook book;
  Counters counts;
  bool unsaved = false;
  std::string trouble;  ///< with saving
  std::optional<std::chrono::steady_clock::time_point> seen_saved;
  std::optional<AccessTime> latest;
};

/// A clock that was put right by years, as that of a Pi is whenever it finds the internet, is nobody's
/// absence. Before anything else is done with a time. Returns the latest of all threads' times: one that was
/// read before the clock was put right must not count after that.
AccessTime Access::State::follow_clock(const AccessTime& now) {
  constexpr std::chrono::hours kJump{1};
  if (!latest) book.begin(now.wall);
  if (latest && now.steady < latest->steady) return *latest;
  if (latest) {
    const auto passed = std::chrono::floor<std::chrono::seconds>(now.steady - latest->steady);
    if (now.wall - latest->wall - passed > kJump) {
      book.put_forward(latest->wall, now.wall);
      unsaved = true;
    }
  }
  latest = now;
  return now;
}

void Access::State::load(const std::string& folder) {
  file.emplace(folder, "access.json");
  notice = file->load([this](const std::string& text) { book.read_json(text); });
  if (!notice.empty()) notice += " Nobody is paired any more: see the console for the code.";
  trouble = file->trouble();
  unsaved = !trouble.empty();
}

Judgement Access::State::judge(const AccessRequest& request, Role needed, const AccessTime& now,
                               Check check) {
  const Shown shown(request);
  const std::lock_guard lock(mutex);
  if (const auto refusal = (way_in.*check)(request)) {
    counts.add(refusal->counter);
    return refused(403, refusal->why);
  }
  Judgement judgement = identify(request, shown, follow_clock(now));
  if (judgement.role >= needed) return judgement;
  if (judgement.role != Role::kNone) {
    counts.add("access.role_too_low");
    return refused(
        403, "this needs " + article(needed) + ", and " + judgement.name + " is " + article(judgement.role));
  }
  counts.add("access.not_signed_in");
  return refused(401, shown.any ? "the session or token is not valid, or not any more"
                                : "this needs a paired browser or a token");
}

Judgement Access::State::identify(const AccessRequest& request, const Shown& shown, const AccessTime& now) {
  const auto address = parse_ip(request.address);
  if (trust_loopback && shown.kind != Kind::kToken && address && address->is_loopback())
    return {200, {}, Role::kAdmin, kLoopbackId, "this machine"};
  for (const Digest& digest : shown.digests) {
    Credential* found = book.find(shown.kind, digest, now.wall);
    if (found == nullptr) continue;
    if (CredentialBook::see(*found, now.wall)) unsaved = true;
    return {200, {}, found->role, found->id, found->name};
  }
  return {};
}

/// Takes the code that was typed; otherwise says why not.
Admission Access::State::take(const std::string& typed, const std::string& address, const AccessTime& now,
                              PairingCode& code) {
  const IpAddress from = parse_ip(address).value_or(IpAddress{});
  const std::lock_guard lock(mutex);
  if (const auto wait = back_off.wait(from, now.steady); wait.count() > 0) {
    counts.add("access.must_wait");
    const int wait_s = static_cast<int>(wait.count());
    return no_admission(429, "too many wrong codes; try again in " + std::to_string(wait_s) + " s", wait_s);
  }
  auto taken = codes.take(typed, now.steady);
  if (!taken) {
    back_off.failed(from, now.steady);
    counts.add("access.wrong_code");
    return no_admission(401, "the code is not right, was used, or has expired");
  }
  back_off.succeeded(from);
  code = std::move(*taken);
  return {};
}

Admission Access::State::admit(Kind kind, const std::string& name, Role role, const AccessTime& now) {
  if (!is_name(name)) return no_admission(422, "a name has 1 to 64 bytes and no control characters");
  Admission admission;
  admission.secret = new_secret();
  if (kind == Kind::kSession) admission.set_cookie = cookie(admission.secret, kCookieLasts_s);
  {
    const std::lock_guard lock(mutex);
    const WallTime wall = follow_clock(now).wall;
    admission.credential = {new_id(), kind, name, role, digest_of(admission.secret), wall, wall};
    if (book.is_full()) book.drop_expired(wall);
    if (book.is_full()) return no_admission(409, "too many devices and tokens; revoke some first");
    book.add(admission.credential);
  }
  save();
  return admission;
}

std::string Access::State::save() {
  const std::lock_guard lock(saving);
  if (!file) return {};
  std::string text;
  {
    const std::lock_guard short_lock(mutex);
    text = book.to_json();
    unsaved = false;
  }
  try {
    file->write(text);
    const std::lock_guard short_lock(mutex);
    trouble.clear();
    return {};
  } catch (const std::exception& error) {
    const std::lock_guard short_lock(mutex);
    unsaved = true;
    counts.add("access.not_saved");
    return trouble = error.what();
  }
}

Access::Access(AccessSetup setup) : state_(std::make_unique<State>(std::move(setup))) {}

Access::~Access() {
  if (state_->unsaved) state_->save();
}

Judgement Access::judge(const AccessRequest& request, Role needed, const AccessTime& now) {
  return state_->judge(request, needed, now, &WayIn::refuse);
}

Judgement Access::judge_stop(const AccessRequest& request, const AccessTime& now) {
  return state_->judge(request, Role::kNone, now, &WayIn::refuse_stop);
}

std::string Access::why_ended(const std::string& id, Role needed, const AccessTime& now) {
  if (needed == Role::kNone || (id == kLoopbackId && state_->trust_loopback)) return {};
  const std::lock_guard lock(state_->mutex);
  const WallTime wall = state_->follow_clock(now).wall;
  Credential* found = state_->book.find(id, wall);
  if (found == nullptr) return "signed out, or not seen for too long";
  if (found->role < needed) return "this needs " + article(needed);
  if (CredentialBook::see(*found, wall)) state_->unsaved = true;
  return {};
}

std::optional<PairingCode> Access::owner_code(const AccessTime& now) {
  const std::lock_guard lock(state_->mutex);
  if (state_->book.has_admin(state_->follow_clock(now).wall)) return std::nullopt;
  auto code = state_->codes.for_owner(now.steady);
  return code ? code : state_->codes.add(Role::kAdmin, true, now.steady + kOwnerCodeLasts);
}

PairingCode Access::invite(Role role, const AccessTime& now) {
  const std::lock_guard lock(state_->mutex);
  return state_->codes.add(role, false, now.steady + std::chrono::minutes(state_->config.invitation_min));
}

Admission Access::pair(const std::string& code, const std::string& name, const std::string& address,
                       const AccessTime& now) {
  if (!is_name(name)) return no_admission(422, "a name has 1 to 64 bytes and no control characters");
  PairingCode taken;
  Admission admission = state_->take(code, address, now, taken);
  if (!admission.is_in()) return admission;
  admission = state_->admit(Kind::kSession, name, taken.role, now);
  const std::lock_guard lock(state_->mutex);
  if (!admission.is_in()) {
    state_->codes.put_back(std::move(taken));
  } else if (taken.role == Role::kAdmin) {
    state_->codes.drop_for_owner();
  }
  return admission;
}

Admission Access::make_token(const std::string& name, Role role, const AccessTime& now) {
  return state_->admit(Kind::kToken, name, role, now);
}

std::vector<Credential> Access::credentials(const AccessTime& now) const {
  const std::lock_guard lock(state_->mutex);
  return state_->book.all(state_->follow_clock(now).wall);
}

Judgement Access::revoke(const std::string& id) {
  {
    const std::lock_guard lock(state_->mutex);
    if (!state_->book.remove(id)) return refused(404, "there is no such device or token");
    state_->unsaved = true;
  }
  const std::string trouble = state_->save();
  if (trouble.empty()) return {};
  return refused(500, "revoked, but only until the program ends: " + trouble);
}

std::string Access::clearing_cookie() { return cookie("", 0); }

void Access::set_addresses(const std::vector<std::string>& addresses) {
  const std::lock_guard lock(state_->mutex);
  state_->way_in.set_addresses(addresses);
}

void Access::tend(const AccessTime& now) {
  {
    const std::lock_guard lock(state_->mutex);
    state_->follow_clock(now);
    const bool is_early = state_->seen_saved && now.steady - *state_->seen_saved < kSaveSeenEvery;
    if (!state_->unsaved || (is_early && state_->trouble.empty())) return;
    state_->seen_saved = now.steady;
  }
  state_->save();
}

const std::string& Access::notice() const { return state_->notice; }

std::string Access::trouble() const {
  const std::lock_guard lock(state_->mutex);
  return state_->trouble;
}

Counters Access::counts() const {
  const std::lock_guard lock(state_->mutex);
  return state_->counts;
}

}  // namespace dynslam
