// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "config.h"
#include "device/devices.h"
#include "pipe/clock.h"

namespace dynslam {

/// The drivers of the devices that the configuration names. None of them need be there yet: each finds its
/// device, and finds it again. A device whose driver is not built in answers with a DeviceError that says so.
/// `clock` must outlive them and run like life.
Devices make_real_devices(const Config& config, const Clock& clock);

}  // namespace dynslam
