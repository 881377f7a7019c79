// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/counters.h"
#include "server/access/access_config.h"
#include "server/access/access_request.h"
#include "server/access/access_time.h"
#include "server/access/credential.h"
#include "server/access/pairing_codes.h"
#include "server/access/role.h"

namespace dynslam {

/// What the program knows and tells.
struct AccessSetup {
  AccessConfig config;
  std::string host_name;               ///< of this machine
  std::optional<std::string> folder;   ///< where `access.json` is kept; none: all is forgotten at the end
  bool trust_loopback = false;         ///< whoever asks from this machine is an admin, as in a simulation
  std::vector<std::string> addresses;  ///< of this machine with their prefix, as own_addresses() says
};

/// Whether somebody is let in, and as whom.
struct Judgement {
  int status = 200;         ///< 200, or what the answer's status must be: 401 or 403; 404 or 500 of revoke()
  std::string why;          ///< one sentence for the client; empty when let in
  Role role = Role::kNone;  ///< may be more than was needed
  std::string id;           ///< of the credential; empty for a stranger
  std::string name;         ///< whose it is; empty for a stranger
  bool is_in() const { return status == 200; }
};

/// What comes of asking for a new credential.
struct Admission {
  int status = 200;       ///< or 401 (code), 409 (too many), 422 (name), 429 (wait)
  std::string why;        ///< one sentence for the client; empty when it worked
  int retry_after_s = 0;  ///< with 429: seconds, for the header Retry-After
  Credential credential;
  std::string secret;      ///< shown this once, kept nowhere; of a session it is in `set_cookie`
  std::string set_cookie;  ///< of a session: value of the header Set-Cookie
  bool is_in() const { return status == 200; }
};

/// Who may do what: pairs people's browsers and programs with the robot, knows them again, and keeps
/// strangers, foreign pages and far away networks out. Nobody is ever locked out: waits grow to a cap, each
/// address has its own, a credential is never affected, and stopping needs none.
///
/// Any thread; no call but those that say so waits for the disk.
class Access {
 public:
  /// The `id` of who is trusted for asking from this machine.
  static constexpr const char* kLoopbackId = "loopback";

  /// Reads the state. One that cannot be used is set aside: whoever sees the console pairs anew. Throws
  /// InputError, in one line, when another program holds the folder.
  explicit Access(AccessSetup setup);
  ~Access();  ///< saves; may wait for the disk
  Access(const Access&) = delete;
  Access& operator=(const Access&) = delete;

  /// Before a request's body is read, and before a WebSocket's handshake is answered.
  Judgement judge(const AccessRequest& request, Role needed, const AccessTime& now);
  /// The same for stopping the robot: near clients that named the right host, whatever else they are or lack.
  Judgement judge_stop(const AccessRequest& request, const AccessTime& now);
  /// For what lasts longer than a request: why the holder of the credential may no longer do what needs the
  /// role, in one sentence; empty while he may.
  std::string why_ended(const std::string& id, Role needed, const AccessTime& now);

  /// The code that makes the owner. There is one as long as there is no admin; whenever it is another than
  /// before it is to be printed.
  std::optional<PairingCode> owner_code(const AccessTime& now);
  /// A code that lets one in, once. At the console it also helps an owner who has lost his phone. REQUIRES:
  /// not kNone.
  PairingCode invite(Role role, const AccessTime& now);
  /// A session for a code. `address` is the client's, for its back-off. Waits for the disk; where that does
  /// not take it, it lasts until the program ends (trouble()).
  Admission pair(const std::string& code, const std::string& name, const std::string& address,
                 const AccessTime& now);
  /// A bearer token for a program; it lasts until it is revoked. REQUIRES: not kNone. As pair().
  Admission make_token(const std::string& name, Role role, const AccessTime& now);

  /// Those who are in, the oldest first.
  std::vector<Credential> credentials(const AccessTime& now) const;
  /// At once, also for open sockets (why_ended). Logging out is revoking one's own. Returns 200, 404, or 500
  /// when it could not be saved: then it is revoked until the program ends. Waits for the disk.
  Judgement revoke(const std::string& id);
  /// Value of the header Set-Cookie that lets a browser forget its session.
  static std::string clearing_cookie();

  /// The machine's addresses now, as own_addresses() says.
  void set_addresses(const std::vector<std::string>& addresses);
  /// Saves when who was last seen; to be called every minute or so, or sessions in use expire over
  /// restarts. Waits for the disk. Throws nothing; counts "access.not_saved".
  void tend(const AccessTime& now);
  /// What people should know of the state that was read, one sentence; empty when all is well.
  const std::string& notice() const;
  /// Why who is let in cannot be saved at the moment, one line; empty when it is.
  std::string trouble() const;
  /// What was refused, by reason, and "access.not_saved".
  Counters counts() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace dynslam
