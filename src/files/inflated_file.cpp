#include "poreshock/files/inflated_file.hpp"

#include <fcntl.h>
#include <zlib.h>

#include <algorithm>
#include <utility>

#include "poreshock/core/error.hpp"

namespace poreshock {
namespace {

constexpr std::uint64_t part = std::uint64_t{1} << 18;  // bytes that are worked on at once
constexpr int any_header = 47;                          // zlib's or gzip's, whichever is found

}  // namespace

InflatedFile::InflatedFile(std::string path, std::uint64_t begin)
    : path_(std::move(path)), begin_(begin) {}

InflatedFile::~InflatedFile() {
  if (stream_) inflateEnd(stream_.get());
}

void InflatedFile::start() {
  if (!file_) file_.emplace(path_, O_RDONLY);
  if (stream_) inflateEnd(stream_.get());
  stream_ = std::make_unique<z_stream>();
  if (inflateInit2(stream_.get(), any_header) != Z_OK) {
    throw SystemError("out of memory: " + path_ + " cannot be decompressed");
  }
  read_to_ = begin_;
  position_ = 0;
  ended_ = false;
  damage_.clear();
}

/// False at the end of the file.
bool InflatedFile::refill() {
  if (stream_->avail_in > 0) return true;
  const std::uint64_t size = file_->size();
  input_.resize(size > read_to_ ? std::min(part, size - read_to_) : 0);
  if (input_.empty()) return false;
  file_->read(read_to_, input_.data(), input_.size());
  read_to_ += input_.size();
  stream_->next_in = reinterpret_cast<Bytef*>(input_.data());
  stream_->avail_in = static_cast<uInt>(input_.size());
  return true;
}

/// Goes on with the next gzip file where some were written one after the other.
void InflatedFile::end_member() {
  constexpr Bytef gzip = 0x1f;
  ended_ = !refill() || *stream_->next_in != gzip || inflateReset(stream_.get()) != Z_OK;
}

std::uint64_t InflatedFile::inflate_some(std::byte* data, std::uint64_t count) {
  stream_->next_out = reinterpret_cast<Bytef*>(data);
  stream_->avail_out = static_cast<uInt>(count);
  while (stream_->avail_out > 0 && !ended_) {
    const bool more = refill();
    const int code = more ? inflate(stream_.get(), Z_NO_FLUSH) : Z_BUF_ERROR;
    if (code == Z_OK) continue;
    if (code == Z_STREAM_END) {
      end_member();
      continue;
    }
    ended_ = true;
    damage_ = !more ? "the compressed bytes end too early"
              : stream_->msg != nullptr
                  ? std::string("the compressed bytes are damaged: ") + stream_->msg
                  : "the compressed bytes are damaged";
  }
  const std::uint64_t made = count - stream_->avail_out;
  position_ += made;
  return made;
}

std::uint64_t InflatedFile::read(std::uint64_t offset, std::byte* data, std::uint64_t count) {
  if (!stream_ || offset < position_) start();
  std::vector<std::byte> passed(offset > position_ ? part : 0);
  while (position_ < offset && !ended_) {
    inflate_some(passed.data(), std::min(part, offset - position_));
  }
  std::uint64_t made = 0;
  while (made < count && !ended_) {
    made += inflate_some(data + made, std::min(part, count - made));
  }
  return made;
}

std::uint64_t InflatedFile::size(std::uint64_t most) {
  std::byte last{};
  read(most, &last, 0);
  return position_;
}

}  // namespace poreshock
