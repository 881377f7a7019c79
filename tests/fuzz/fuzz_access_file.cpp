// SPDX-License-Identifier: MIT
#include <cstdint>
#include <cstdlib>

#include "base/error.h"
#include "server/access/credential_book.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dynslam;
  CredentialBook book{std::chrono::days(90)}, back{std::chrono::days(90)};
  try {
    book.read_json(std::string_view(reinterpret_cast<const char*>(data), size));
  } catch (const InputError&) {
    return 0;
  }
  // What was taken can be written, and read again.
  back.read_json(book.to_json());
  if (back.to_json() != book.to_json()) std::abort();
  return 0;
}
