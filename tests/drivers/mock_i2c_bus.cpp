// SPDX-License-Identifier: MIT
#include "drivers/mock_i2c_bus.h"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <vector>

#include <linux/i2c-dev.h>
#include <linux/i2c.h>
#include <umockdev.h>

#include "drivers/real_time.h"

namespace dynslam::test {
namespace {

/// A piece of the caller's memory; what is changed is written back when the call ends.
class Memory {
 public:
  Memory(UMockdevIoctlData* from, std::size_t offset, std::size_t size)
      : data_(umockdev_ioctl_data_resolve(from, offset, size, nullptr)) {
    if (!data_) throw std::runtime_error("a system call with a pointer to nowhere");
  }
  ~Memory() { g_object_unref(data_); }
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;

  UMockdevIoctlData* data() const { return data_; }
  std::span<std::uint8_t> bytes() const { return {data_->data, static_cast<std::size_t>(data_->data_len)}; }
  template <class T>
  T as() const {
    T value;
    std::memcpy(&value, data_->data, sizeof(T));
    return value;
  }

 private:
  UMockdevIoctlData* data_;
};

UMockdevIoctlData* argument_of(UMockdevIoctlClient* client) { return umockdev_ioctl_client_get_arg(client); }

std::span<std::uint8_t> buffer_of(UMockdevIoctlClient* client) {
  UMockdevIoctlData* data = argument_of(client);
  return {data->data, static_cast<std::size_t>(data->data_len)};
}

unsigned long value_of(UMockdevIoctlClient* client) {
  unsigned long value = 0;
  std::memcpy(&value, argument_of(client)->data, sizeof(value));
  return value;
}

std::string file_of(int bus) { return "/dev/i2c-" + std::to_string(bus); }

void connect(UMockdevIoctlBase* handler, const char* signal,
             int (*call)(UMockdevIoctlBase*, UMockdevIoctlClient*, void*), void* self) {
  g_signal_connect(handler, signal, G_CALLBACK(call), self);
}

}  // namespace

MockI2cBuses::MockI2cBuses() : testbed_(umockdev_testbed_new()) {
  if (!umockdev_in_mock_environment()) throw std::runtime_error("libumockdev-preload is not loaded");
}

MockI2cBuses::~MockI2cBuses() {
  for (auto& [file, bus] : buses_) {
    umockdev_testbed_detach_ioctl(testbed_, file.c_str(), nullptr);
    g_object_unref(bus.handler);
  }
  g_object_unref(testbed_);
}

void MockI2cBuses::add_bus(int number, bool software) {
  const std::string n = std::to_string(number), file = file_of(number);
  const std::string device = "P: /devices/platform/soc/" + n + ".i2c/i2c-" + n + "/i2c-dev/i2c-" + n +
                             "\nN: i2c-" + n + "\nE: DEVNAME=" + file +
                             "\nE: SUBSYSTEM=i2c-dev\nE: MAJOR=89" + "\nE: MINOR=" + n + "\nA: dev=89:" + n +
                             "\n\n";
  if (!umockdev_testbed_add_from_string(testbed_, device.c_str(), nullptr))
    throw std::runtime_error("cannot add " + file);
  UMockdevIoctlBase* handler = umockdev_ioctl_base_new();
  connect(handler, "handle-ioctl", &on_ioctl, this);
  connect(handler, "handle-read", &on_read, this);
  connect(handler, "handle-write", &on_write, this);
  {
    const std::lock_guard lock(mutex_);
    buses_[file] = {software, {}, handler};
  }
  if (!umockdev_testbed_attach_ioctl(testbed_, file.c_str(), handler, nullptr))
    throw std::runtime_error("cannot attach to " + file);
}

void MockI2cBuses::plug(int bus, int address, I2cChip* chip) {
  const std::lock_guard lock(mutex_);
  buses_.at(file_of(bus)).chips[address] = chip;
}

int MockI2cBuses::long_transfers() const {
  const std::lock_guard lock(mutex_);
  return long_transfers_;
}

I2cChip* MockI2cBuses::chip_at(UMockdevIoctlClient* client, int address) {
  const auto& chips = buses_.at(umockdev_ioctl_client_get_devnode(client)).chips;
  const auto chip = chips.find(address);
  return chip == chips.end() ? nullptr : chip->second;
}

I2cChip* MockI2cBuses::chip_of(UMockdevIoctlClient* client) { return chip_at(client, addresses_[client]); }

int MockI2cBuses::on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, void* self) {
  be_no_part_of_the_program();
  auto& buses = *static_cast<MockI2cBuses*>(self);
  Answer answer;
  {
    const std::lock_guard lock(buses.mutex_);
    answer = buses.ioctl(client);
  }
  umockdev_ioctl_client_complete(client, answer.error ? -1 : answer.result, answer.error);
  return TRUE;
}

int MockI2cBuses::on_read(UMockdevIoctlBase*, UMockdevIoctlClient* client, void* self) {
  be_no_part_of_the_program();
  auto& buses = *static_cast<MockI2cBuses*>(self);
  const auto into = buffer_of(client);
  int error = EREMOTEIO;
  {
    const std::lock_guard lock(buses.mutex_);
    if (I2cChip* chip = buses.chip_of(client)) error = chip->read(into);
  }
  umockdev_ioctl_client_complete(client, error ? -1 : static_cast<long>(into.size()), error);
  return TRUE;
}

int MockI2cBuses::on_write(UMockdevIoctlBase*, UMockdevIoctlClient* client, void* self) {
  be_no_part_of_the_program();
  auto& buses = *static_cast<MockI2cBuses*>(self);
  const auto bytes = buffer_of(client);
  int error = EREMOTEIO;
  {
    const std::lock_guard lock(buses.mutex_);
    if (I2cChip* chip = buses.chip_of(client)) error = chip->write(bytes);
  }
  umockdev_ioctl_client_complete(client, error ? -1 : static_cast<long>(bytes.size()), error);
  return TRUE;
}

MockI2cBuses::Answer MockI2cBuses::ioctl(UMockdevIoctlClient* client) {
  switch (umockdev_ioctl_client_get_request(client)) {
    case I2C_SLAVE:
    case I2C_SLAVE_FORCE:
      addresses_[client] = static_cast<int>(value_of(client));
      return {};
    case I2C_TIMEOUT:
    case I2C_RETRIES:
      return {};
    case I2C_FUNCS: {
      const bool software = buses_.at(umockdev_ioctl_client_get_devnode(client)).software;
      const unsigned long functions = I2C_FUNC_I2C | I2C_FUNC_SMBUS_EMUL | (software ? I2C_FUNC_NOSTART : 0);
      const Memory out(argument_of(client), 0, sizeof(functions));
      std::memcpy(out.bytes().data(), &functions, sizeof(functions));
      return {};
    }
    case I2C_SMBUS:
      return smbus(client);
    case I2C_RDWR:
      return transfers(client);
    default:
      return {-1, ENOTTY};
  }
}

/// What the kernel makes of an SMBus call on an adapter that only knows plain transfers.
MockI2cBuses::Answer MockI2cBuses::smbus(UMockdevIoctlClient* client) {
  const Memory call(argument_of(client), 0, sizeof(i2c_smbus_ioctl_data));
  const auto ask = call.as<i2c_smbus_ioctl_data>();
  I2cChip* chip = chip_of(client);
  if (!chip) return {-1, EREMOTEIO};
  std::vector<std::uint8_t> out{ask.command};
  if (ask.size == I2C_SMBUS_BYTE && ask.read_write == I2C_SMBUS_WRITE) return {0, chip->write(out)};
  const Memory data(call.data(), offsetof(i2c_smbus_ioctl_data, data), sizeof(i2c_smbus_data));
  const auto bytes = data.bytes();
  // libi2c writes, and reads of 32 bytes, go by the older number, whose reads are always that long.
  const bool older = ask.size == I2C_SMBUS_I2C_BLOCK_BROKEN;
  const bool block = older || ask.size == I2C_SMBUS_I2C_BLOCK_DATA;
  if (older && ask.read_write == I2C_SMBUS_READ) bytes[0] = I2C_SMBUS_BLOCK_MAX;
  if (!block && ask.size != I2C_SMBUS_BYTE_DATA) return {-1, EOPNOTSUPP};
  if (block && (bytes[0] == 0 || bytes[0] > I2C_SMBUS_BLOCK_MAX)) return {-1, EINVAL};
  const auto values = block ? bytes.subspan(1, bytes[0]) : bytes.first(1);
  if (ask.read_write == I2C_SMBUS_WRITE) {
    out.insert(out.end(), values.begin(), values.end());
    return {0, chip->write(out)};
  }
  if (const int error = chip->write(out)) return {-1, error};
  return {0, chip->read(values)};
}

MockI2cBuses::Answer MockI2cBuses::transfers(UMockdevIoctlClient* client) {
  ++long_transfers_;
  const Memory call(argument_of(client), 0, sizeof(i2c_rdwr_ioctl_data));
  const std::size_t n = call.as<i2c_rdwr_ioctl_data>().nmsgs;
  if (n == 0 || n > I2C_RDWR_IOCTL_MAX_MSGS) return {-1, EINVAL};
  const Memory messages(call.data(), offsetof(i2c_rdwr_ioctl_data, msgs), n * sizeof(i2c_msg));
  for (std::size_t i = 0; i < n; ++i) {
    i2c_msg message;
    std::memcpy(&message, messages.bytes().data() + i * sizeof(i2c_msg), sizeof(message));
    I2cChip* chip = chip_at(client, message.addr);
    if (!chip) return {-1, EREMOTEIO};
    const Memory bytes(messages.data(), i * sizeof(i2c_msg) + offsetof(i2c_msg, buf), message.len);
    const bool read = (message.flags & I2C_M_RD) != 0;
    if (read && i + 1 != n) return {-1, EOPNOTSUPP};  // i2c-bcm2835 reads in the last message only
    if (const int error = read ? chip->read(bytes.bytes()) : chip->write(bytes.bytes())) return {-1, error};
  }
  return {static_cast<long>(n), 0};
}

}  // namespace dynslam::test
