// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace dynslam {

/// A queue by whole keys that never asks for less than it gave (Dial, 1969): a ring of buckets, each Width
/// wide; what is in one bucket comes last in, first out. Keeps its memory.
template <class Value, std::uint32_t Width, std::size_t Buckets>
class BucketQueue {
 public:
  void clear() {
    for (auto& bucket : buckets_) bucket.clear();
    size_ = 0;
    began_ = false;
  }
  /// REQUIRES: `key` is less than Width * (Buckets - 1) above that of what was taken last. A key below it
  /// counts as the same.
  void push(std::uint32_t key, const Value& value) {
    const std::uint32_t bucket = key / Width;
    if (!began_) now_ = bucket;
    began_ = true;
    buckets_[std::max(bucket, now_) % Buckets].push_back(value);
    ++size_;
  }
  bool empty() const { return size_ == 0; }
  /// Whether such a key may be pushed now.
  bool takes(std::uint32_t key) const { return !began_ || key / Width < now_ + Buckets - 1; }
  std::optional<Value> pop() {
    if (size_ == 0) return std::nullopt;
    while (buckets_[now_ % Buckets].empty()) ++now_;
    auto& bucket = buckets_[now_ % Buckets];
    const Value value = bucket.back();
    bucket.pop_back();
    --size_;
    return value;
  }

 private:
  std::vector<std::vector<Value>> buckets_ = std::vector<std::vector<Value>>(Buckets);
  std::uint32_t now_ = 0;
  std::size_t size_ = 0;
  bool began_ = false;
};

}  // namespace dynslam
