// SPDX-License-Identifier: MIT
#include "drivers/i2c/i2c_device.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <linux/i2c-dev.h>
#include <linux/i2c.h>
#include <sys/ioctl.h>
#include <unistd.h>
extern "C" {  // which the header itself does not say
#include <i2c/smbus.h>
}

namespace dynslam {
namespace {

constexpr auto kPause = std::chrono::milliseconds(1);
constexpr unsigned long kTimeout_10ms = 5;
constexpr int kTaken = ETXTBSY;  ///< no bus says this

/// What the next try may well get past. Bus drivers differ in what they call a missing acknowledgement: most
/// say EREMOTEIO, i2c-gpio ENXIO and EIO.
bool is_passing(int error) {
  return error == EREMOTEIO || error == ENXIO || error == EIO || error == EAGAIN || error == EINTR;
}

/// Whether the bus itself still seems to be there.
bool is_of_the_chip(int error) { return is_passing(error) || error == ETIMEDOUT; }

/// libi2c returns -errno, or how many bytes were read, of which none may be missing.
int error_of_read(int result, std::size_t wanted) {
  if (result < 0) return -result;
  return static_cast<std::size_t>(result) == wanted ? 0 : EIO;
}

int read_long_burst(int bus, int address, std::uint8_t first, std::span<std::uint8_t> into) {
  const auto chip = static_cast<std::uint16_t>(address);
  std::array<i2c_msg, 2> messages{
      {{chip, 0, 1, &first}, {chip, I2C_M_RD, static_cast<std::uint16_t>(into.size()), into.data()}}};
  i2c_rdwr_ioctl_data both{messages.data(), messages.size()};
  return ::ioctl(bus, I2C_RDWR, &both) < 0 ? errno : 0;
}

int read_all(int bus, std::span<std::uint8_t> into) {
  const ssize_t n = ::read(bus, into.data(), into.size());
  return n < 0 ? errno : error_of_read(static_cast<int>(n), into.size());
}

int write_once(int bus, std::uint8_t first, std::span<const std::uint8_t> values) {
  if (values.empty()) return -i2c_smbus_write_byte(bus, first);
  if (values.size() == 1) return -i2c_smbus_write_byte_data(bus, first, values[0]);
  const auto n = static_cast<std::uint8_t>(values.size());
  return -i2c_smbus_write_i2c_block_data(bus, first, n, values.data());
}

/// Takes the chip for this device alone: two programs would each get what the other asked for. By a lock on
/// the byte of the bus's file that is its address; where files know no locks it is used without.
bool is_taken(int bus, int address) {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_start = address;
  lock.l_len = 1;
  return ::fcntl(bus, F_OFD_SETLK, &lock) != 0 && (errno == EAGAIN || errno == EACCES);
}

std::string hex(int address) {
  std::array<char, 8> digits;
  return "0x" + std::string(digits.data(), std::to_chars(digits.begin(), digits.end(), address, 16).ptr);
}

}  // namespace

I2cDevice::I2cDevice(std::string name, std::string bus, int address)
    : name_(std::move(name)), bus_(std::move(bus)), address_(address) {}

I2cDevice::~I2cDevice() { close_bus(); }

/// `transfer` returns 0 or an errno.
template <class Transfer>
int I2cDevice::attempt(int tries, Transfer&& transfer) {
  const std::lock_guard lock(mutex_);
  for (int tried = 1;; ++tried) {
    int error = open_bus();
    if (error == 0) error = transfer();
    if (error == 0) return 0;
    note(error);
    if (!is_of_the_chip(error)) close_bus();
    if (!is_passing(error) || tried >= tries) return error;
    count("retries");
    std::this_thread::sleep_for(kPause);
  }
}

int I2cDevice::read_registers(std::uint8_t first, std::span<std::uint8_t> into, int tries) {
  return attempt(tries, [&] {
    if (into.size() > I2C_SMBUS_BLOCK_MAX) return read_long_burst(bus_file_, address_, first, into);
    const auto n = static_cast<std::uint8_t>(into.size());
    return error_of_read(i2c_smbus_read_i2c_block_data(bus_file_, first, n, into.data()), n);
  });
}

int I2cDevice::write(std::uint8_t first, std::span<const std::uint8_t> values, int tries) {
  return attempt(tries, [&] { return write_once(bus_file_, first, values); });
}

int I2cDevice::ask(std::uint8_t command, std::span<std::uint8_t> answer, int tries) {
  return attempt(tries, [&] {
    const int error = write_once(bus_file_, command, {});
    return error ? error : read_all(bus_file_, answer);
  });
}

int I2cDevice::open_bus() {
  if (bus_file_ >= 0) return 0;
  bus_file_ = ::open(bus_.c_str(), O_RDWR | O_CLOEXEC);
  if (bus_file_ < 0) return errno;
  if (::ioctl(bus_file_, I2C_SLAVE, static_cast<unsigned long>(address_)) < 0) {
    const int error = errno;
    close_bus();
    return error;
  }
  if (is_taken(bus_file_, address_)) {
    close_bus();
    return kTaken;
  }
  // Some buses know none of this: they are used as they are. Tries are ours: a software bus that hangs spins
  // in the kernel for 0.2 s a try, and four in a row are too much for a real-time thread.
  ::ioctl(bus_file_, I2C_TIMEOUT, kTimeout_10ms);
  ::ioctl(bus_file_, I2C_RETRIES, 0UL);
  unsigned long functions = 0;
  ::ioctl(bus_file_, I2C_FUNCS, &functions);
  software_bus_ = (functions & I2C_FUNC_NOSTART) != 0;  // of the Pi's buses only i2c-gpio can
  return 0;
}

void I2cDevice::close_bus() {
  if (bus_file_ >= 0) ::close(std::exchange(bus_file_, -1));
}

void I2cDevice::note(int error) {
  if (error == ETIMEDOUT) {
    count("timeouts");
  } else {
    count(error == EREMOTEIO || error == ENXIO ? "nak" : "failed");
  }
}

void I2cDevice::count(std::string_view what, std::uint64_t n) {
  const std::lock_guard lock(counters_mutex_);
  counters_.add(what, n);
}

Counters I2cDevice::counters() const {
  const std::lock_guard lock(counters_mutex_);
  return counters_;
}

DeviceError I2cDevice::failure(int error) const {
  const std::string at = hex(address_) + " on " + bus_;
  const auto says = [&](const std::string& what) { return DeviceError(name_ + ": " + what); };
  switch (error) {
    case ENOENT:
    case ENODEV:
      return says("no " + bus_ +
                  ": is it switched on in config.txt (dtparam=i2c_arm=on, or dtoverlay=i2c-gpio for a bus of "
                  "its own), and the module i2c-dev loaded?");
    case EACCES:
    case EPERM:
      return says(bus_ + " may not be opened: is the user in group i2c?");
    case EBUSY:
      return says(at + " is held by a driver of the kernel: switch its overlay off");
    case kTaken:
      return says(at + " is in use: does dynslam run already? (systemctl stop dynslam)");
    case EREMOTEIO:
    case ENXIO:
      return says("nothing answers at " + at + ": is it wired and powered, and this its address?");
    case ETIMEDOUT:
      return says(bus_ + " hangs: look at its wires, then cut the power for a moment");
    case EIO:
      return says("transfers with " + at + " break off: look at wires and bus speed");
    default:
      return says(at + ": " + std::generic_category().message(error));
  }
}

}  // namespace dynslam
