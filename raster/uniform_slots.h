// Many values of one uniform block in one buffer, of which a draw sees one at a time.
#pragma once

#include <cstddef>
#include <cstring>
#include <vector>

#include "raster/gl/objects.h"

namespace pb {

template <class T>
class UniformSlots {
 public:
  UniformSlots() = default;
  UniformSlots(const gl::Context& context, std::size_t count)
      : stride_(roundedUp(sizeof(T), static_cast<std::size_t>(context.integer(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT)))),
        bytes_(count * stride_),
        buffer_(context.functions(), bytes_.size()) {}

  std::size_t size() const { return stride_ == 0 ? 0 : bytes_.size() / stride_; }

  // Seen by draws after upload().
  void set(std::size_t slot, const T& value) { std::memcpy(&bytes_[slot * stride_], &value, sizeof(T)); }
  void upload() { buffer_.write(0, bytes_); }

  void bind(int block, std::size_t slot) const {
    buffer_.gl().BindBufferRange(GL_UNIFORM_BUFFER, static_cast<GLuint>(block), buffer_.id(),
                                 static_cast<GLintptr>(slot * stride_), sizeof(T));
  }

 private:
  static std::size_t roundedUp(std::size_t size, std::size_t alignment) {
    return (size + alignment - 1) / alignment * alignment;
  }

  std::size_t stride_ = 0;
  std::vector<std::byte> bytes_;
  gl::Buffer buffer_;
};

}  // namespace pb
