#include "engine/storage/growing_xml.hpp"

#include "engine/storage/text_file.hpp"

#include <cassert>
#include <filesystem>
#include <utility>

namespace minamo {

namespace {

constexpr std::uint64_t page = 4096;
constexpr std::string_view opening = "<?minamo ";
constexpr std::string_view closing = "?>";
constexpr std::string_view skipped = "<?minamo ?>";

std::string spaces(std::uint64_t count) { return std::string(count, ' '); }

/// From there on, in one page.
std::uint64_t in_one_page(std::uint64_t from, std::uint64_t bytes) {
  return from / page == (from + bytes - 1) / page ? from : (from / page + 1) * page;
}

}  // namespace

GrowingXml::GrowingXml(std::string path, std::string head, std::string tail)
    : path_(std::move(path)), head_(std::move(head)), tail_(std::move(tail)) {}

std::uint64_t GrowingXml::place_of_tail(std::uint64_t from) const {
  return in_one_page(from, tail_.size() + opening.size());
}

void GrowingXml::write(std::uint64_t offset, std::string_view text) {
  file_.overwrite(offset, std::as_bytes(std::span(text)));
}

void GrowingXml::make(std::string_view element) {
  std::string text = head_;
  text += element;
  const std::uint64_t tail = place_of_tail(text.size());
  text += spaces(tail - text.size());
  write_text(path_, text + tail_);
  file_ = AppendFile(path_, text.size() + tail_.size());
  position_ = tail;
}

void GrowingXml::append(std::string_view element) {
  assert(element.find(closing) == std::string_view::npos);
  if (position_ == 0) return make(element);
  const std::uint64_t kept = tail_.size() + opening.size();
  const std::uint64_t end_now = position_ + tail_.size();
  const std::uint64_t begin = position_ + kept;
  const std::uint64_t tail = place_of_tail(begin + element.size());
  const std::uint64_t end = in_one_page(tail + kept, skipped.size());
  try {
    write(end_now, spaces(end - end_now) + std::string(skipped));
    write(end_now, opening);
    write(begin, std::string(element) + spaces(tail - begin - element.size()) + tail_);
  } catch (...) {
    file_.cut(end_now);
    throw;
  }
  write(position_, spaces(kept));
  position_ = tail;
  file_.cut(tail + tail_.size());
}

bool GrowingXml::reaches(std::uint64_t position) const {
  std::error_code error;
  const auto size = std::filesystem::file_size(path_, error);
  return position == 0 || (!error && size >= position + tail_.size());
}

void GrowingXml::restore(std::uint64_t position) {
  if (position == 0) {
    file_ = AppendFile();
    std::error_code not_there;
    std::filesystem::remove(path_, not_there);
    position_ = 0;
    return;
  }
  const std::uint64_t size = std::filesystem::file_size(path_);
  const std::uint64_t end = position + tail_.size();
  file_ = AppendFile(path_, size);
  if (size > end) {
    // What goes is skipped first, then cut off.
    write(size, spaces(in_one_page(size, skipped.size()) - size) + std::string(skipped));
    write(position, tail_ + std::string(opening));
  }
  file_.cut(end);
  position_ = position;
}

}  // namespace minamo
