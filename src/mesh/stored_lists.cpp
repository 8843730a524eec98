// SPDX-License-Identifier: MIT
#include "mesh/stored_lists.h"

namespace meshbound {

NumberLists StoredLists::range(std::size_t first, std::size_t end) const {
  std::vector<std::uint64_t> begin(end - first + 1);
  begin_.read(first, begin);
  NumberLists lists;
  lists.numbers.resize(static_cast<std::size_t>(begin.back() - begin.front()));
  numbers_.read(static_cast<std::size_t>(begin.front()), lists.numbers);
  lists.begin.clear();
  for (const std::uint64_t at : begin) lists.begin.push_back(static_cast<std::uint32_t>(at - begin.front()));
  return lists;
}

NumberLists StoredLists::at(std::span<const std::uint32_t> lists) const {
  constexpr std::size_t block_size = 256;
  NumberLists all, block;
  std::size_t first = 0;
  for (const std::uint32_t list : lists) {
    if (list < first || list >= first + block.size()) {
      first = list - list % block_size;
      block = range(first, std::min(first + block_size, size()));
    }
    const auto numbers = block[list - first];
    all.numbers.insert(all.numbers.end(), numbers.begin(), numbers.end());
    all.end_list();
  }
  return all;
}

void GrowingLists::append(std::size_t list, std::uint32_t number) {
  List& grows = lists_[list];
  grows.last.push_back(number);
  if (grows.last.size() < extent_size) return;
  grows.extents.push_back(numbers_.size());
  numbers_.append(grows.last);
  grows.last.clear();
}

std::vector<std::uint32_t> GrowingLists::operator[](std::size_t list) const {
  const List& of = lists_[list];
  std::vector<std::uint32_t> numbers(of.extents.size() * extent_size);
  for (std::size_t k = 0; k < of.extents.size(); ++k)
    numbers_.read(static_cast<std::size_t>(of.extents[k]), std::span(numbers).subspan(k * extent_size, extent_size));
  numbers.insert(numbers.end(), of.last.begin(), of.last.end());
  return numbers;
}

}  // namespace meshbound
