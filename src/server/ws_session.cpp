// SPDX-License-Identifier: MIT
#include "server/ws_session.h"

#include <algorithm>
#include <array>
#include <cerrno>

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

namespace dynslam {
namespace {

/// The system keeps about this much for a client that does not keep up: little, as it gets old there.
constexpr int kSendBuffer = 128 * 1024;
constexpr std::chrono::seconds kLongestNap{1};
constexpr std::chrono::duration<int, std::milli> kFarewell{300};

bool would_block() { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }

}  // namespace

WsSession::WsSession(int socket, Channel& channel)
    : socket_(socket), channel_(channel), reader_(channel.longest_message()) {
  const int on = 1;
  setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  setsockopt(socket_, SOL_SOCKET, SO_SNDBUF, &kSendBuffer, sizeof(kSendBuffer));
  // More than this does not wait in the system for a slow client, or he would see what was seconds ago.
  const int most_unsent = 8 * 1024;
  setsockopt(socket_, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &most_unsent, sizeof(most_unsent));
  sent_at_ = heard_at_ = pinged_at_ = std::chrono::steady_clock::now();
}

void WsSession::run(const std::atomic<bool>& stopping) {
  bool open = true;
  while (open) {
    SteadyTime now = std::chrono::steady_clock::now();
    if (stopping) {
      open = close({1001, "the robot's program ends"});
    } else if (const auto ended = channel_.ended(now)) {
      open = close(*ended);
    }
    if (!open) break;
    fill(now);
    if (!flush(now) || now - heard_at_ > kSilentFor) break;
    const auto nap = std::clamp<Channel::SteadyTime::duration>(wake_at() - now, {}, kLongestNap);
    pollfd watched{socket_, static_cast<short>(out_.empty() ? POLLIN : POLLIN | POLLOUT), 0};
    const int ready =
        poll(&watched, 1, static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(nap).count()));
    now = std::chrono::steady_clock::now();
    if (stopping) continue;
    if (ready > 0 && (watched.revents & (POLLIN | POLLHUP | POLLERR)) != 0) open = receive(now);
  }
}

/// Takes the next thing to send, once all before it is out.
void WsSession::fill(SteadyTime now) {
  if (!out_.empty()) return;
  if (pong_due_) {
    out_ = ws_frame(WsOpcode::kPong, pong_);
    pong_due_ = false;
  } else if (const auto message = channel_.next(now)) {
    out_ = ws_frame(message->opcode, message->payload);
  } else if (now - heard_at_ > kPingAfter && now - pinged_at_ > kPingAfter) {
    out_ = ws_frame(WsOpcode::kPing, {});
    pinged_at_ = now;
  }
  sent_ = 0;
  sent_at_ = now;
}

/// Sends what goes without waiting, and takes up what comes next; one message at a time, lest a client that
/// listens fast is not listened to. False when the client is gone or takes nothing for too long.
bool WsSession::flush(SteadyTime now) {
  while (sent_ < out_.size()) {
    const ssize_t n = send(socket_, out_.data() + sent_, out_.size() - sent_, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (n < 0) return would_block() && now - sent_at_ < kPatience;
    sent_ += static_cast<std::size_t>(n);
    sent_at_ = now;
  }
  out_.clear();
  fill(now);
  return true;
}

bool WsSession::receive(SteadyTime now) {
  std::array<char, 16384> bytes;
  const ssize_t n = recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (n == 0) return false;
  if (n < 0) return would_block();
  heard_at_ = now;
  reader_.feed({bytes.data(), static_cast<std::size_t>(n)});
  while (const auto message = reader_.next())
    if (!handle(*message, now)) return false;
  return !reader_.fault() || close(*reader_.fault());
}

bool WsSession::handle(const WsMessage& message, SteadyTime now) {
  switch (message.opcode) {
    case WsOpcode::kPing:
      pong_ = message.payload;
      pong_due_ = true;
      return true;
    case WsOpcode::kPong:
      return true;
    case WsOpcode::kClose:
      return close({1000, {}});
    case WsOpcode::kText:
    case WsOpcode::kBinary:
      break;
  }
  const auto closing = channel_.take(message, now);
  return !closing || close(*closing);
}

void WsSession::farewell() {
  shutdown(socket_, SHUT_WR);
  const SteadyTime end = std::chrono::steady_clock::now() + kFarewell;
  std::array<char, 16384> bytes;
  pollfd watched{socket_, POLLIN, 0};
  while (std::chrono::steady_clock::now() < end && poll(&watched, 1, kFarewell.count()) > 0)
    if (recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT) <= 0) break;
  shutdown(socket_, SHUT_RDWR);
}

WsSession::SteadyTime WsSession::wake_at() const {
  if (!out_.empty()) return sent_at_ + kPatience;
  return std::min(channel_.due(), std::max(heard_at_, pinged_at_) + kPingAfter);
}

/// Says why, as far as that goes without waiting. Nothing may follow half a frame.
bool WsSession::close(const WsClosing& closing) {
  const std::string frame = ws_close_frame(closing);
  if (out_.empty() || sent_ == 0) send(socket_, frame.data(), frame.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  return false;
}

}  // namespace dynslam
