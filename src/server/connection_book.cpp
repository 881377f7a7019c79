// SPDX-License-Identifier: MIT
#include "server/connection_book.h"

#include <sys/ioctl.h>
#include <sys/socket.h>

#include "server/access/ip_address.h"

namespace dynslam {
namespace {

constexpr std::chrono::milliseconds kLookEvery{100};

bool is_all_read(int socket) {
  int unread = 0;
  return ioctl(socket, FIONREAD, &unread) != 0 || unread == 0;
}

/// Whose share of the seats an address counts to: of IPv6 a whole subnet is one holder's, who may call
/// himself by any address in it. Link-local ones are all of one subnet.
std::string share_of(const std::string& address) {
  static const IpNetwork kLinkLocal = *parse_network("fe80::/10");
  const auto ip = parse_ip(address);
  if (!ip || kLinkLocal.contains(*ip)) return address;
  const IpAddress holder = holder_of(*ip);
  return {holder.bytes.begin(), holder.bytes.end()};
}

/// The thread that serves it finds it closed. REQUIRES: the book is locked.
void cut(const Connection& connection) {
  if (!connection.closing) shutdown(connection.socket, SHUT_RDWR);
}

}  // namespace

ConnectionBook::ConnectionBook(const Seats::Limits& limits) : seats_(limits), watcher_([this] { watch(); }) {}

ConnectionBook::~ConnectionBook() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  ended_.notify_all();
  watcher_.join();
}

void ConnectionBook::set_port(int port) {
  const std::lock_guard lock(mutex_);
  port_ = port;
}

void ConnectionBook::look() {
  const std::lock_guard lock(mutex_);
  note_new();
  cut_overdue();
}

Connection* ConnectionBook::find(const Peer& peer) {
  const std::lock_guard lock(mutex_);
  if (!connections_.contains(peer)) note_new();
  const auto found = connections_.find(peer);
  return found == connections_.end() || found->second.id == 0 ? nullptr : &found->second;
}

bool ConnectionBook::use(Connection& connection, Seats::Use use) {
  const std::lock_guard lock(mutex_);
  connection.is_web_socket = use == Seats::Use::kControl || use == Seats::Use::kWatch;
  return seats_.use(connection.id, use, std::chrono::steady_clock::now());
}

void ConnectionBook::begin_close(const Peer& peer) {
  const std::lock_guard lock(mutex_);
  const auto found = connections_.find(peer);
  if (found != connections_.end()) found->second.closing = true;
}

void ConnectionBook::closed(const Peer& peer) {
  const std::lock_guard lock(mutex_);
  const auto found = connections_.find(peer);
  if (found == connections_.end()) return;
  seats_.close(found->second.id);
  peers_.erase(found->second.id);
  connections_.erase(found);
}

void ConnectionBook::end_all() {
  const std::lock_guard lock(mutex_);
  note_new();
  for (const auto& [peer, connection] : connections_) {
    if (!connection.closing && connection.is_web_socket) shutdown(connection.socket, SHUT_RD);
    if (!connection.is_web_socket) cut(connection);
  }
}

std::size_t ConnectionBook::taken() const {
  const std::lock_guard lock(mutex_);
  return seats_.taken();
}

std::uint64_t ConnectionBook::refused() const {
  const std::lock_guard lock(mutex_);
  return seats_.refused();
}

void ConnectionBook::watch() {
  std::unique_lock lock(mutex_);
  while (!ended_.wait_for(lock, kLookEvery, [this] { return ending_; })) cut_overdue();
}

/// Gives seats to those that were accepted since the last time, and cuts those that get none.
void ConnectionBook::note_new() {
  if (port_ == 0) return;
  for (const auto& [file, peer] : open_sockets(port_)) {
    if (connections_.contains(peer)) continue;
    Connection& connection = connections_[peer];
    connection.id = seats_.open(share_of(peer.address), std::chrono::steady_clock::now());
    connection.socket = file;
    if (connection.id == 0) {
      cut(connection);
    } else {
      peers_[connection.id] = peer;
    }
  }
}

void ConnectionBook::cut_overdue() {
  const auto of = [this](Seats::Id id) -> const Connection& { return connections_.at(peers_.at(id)); };
  const auto is_heard = [&of](Seats::Id id) { return of(id).closing || is_all_read(of(id).socket); };
  for (const Seats::Id id : seats_.overdue(std::chrono::steady_clock::now(), is_heard)) cut(of(id));
}

}  // namespace dynslam
