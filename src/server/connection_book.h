// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "server/channel.h"
#include "server/open_sockets.h"
#include "server/seats.h"

namespace dynslam {

/// An open connection. What it holds belongs to the thread that serves it.
struct Connection {
  Seats::Id id = 0;  ///< 0: has no seat, and is cut
  int socket = -1;
  bool closing = false;              ///< its socket may be closed at any time
  bool is_web_socket = false;        ///< says farewell when it hears nothing more
  std::unique_ptr<Channel> channel;  ///< of a WebSocket
};

/// The open connections, and a thread that cuts those that hold a seat for nothing. All calls from any
/// thread.
///
/// Invariant: the socket of a connection that is not `closing` is open. So none is cut that is another's by
/// now.
class ConnectionBook {
 public:
  explicit ConnectionBook(const Seats::Limits& limits);
  ~ConnectionBook();
  ConnectionBook(const ConnectionBook&) = delete;
  ConnectionBook& operator=(const ConnectionBook&) = delete;

  /// Before this nothing is seen.
  void set_port(int port);
  /// There may be new connections.
  void look();
  /// Null when it is cut. Stays valid until closed().
  Connection* find(const Peer& peer);
  bool use(Connection& connection, Seats::Use use);
  /// Before and after a connection's socket is closed.
  void begin_close(const Peer& peer);
  void closed(const Peer& peer);
  /// The program ends.
  void end_all();

  std::size_t taken() const;
  std::uint64_t refused() const;

 private:
  void watch();
  void note_new();
  void cut_overdue();

  mutable std::mutex mutex_;
  std::condition_variable ended_;
  bool ending_ = false;
  int port_ = 0;
  Seats seats_;
  std::map<Peer, Connection> connections_;
  std::map<Seats::Id, Peer> peers_;  ///< of those with a seat
  std::thread watcher_;
};

}  // namespace dynslam
