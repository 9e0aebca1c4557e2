// The border between libgnomon and the module libgnomon_image.so: plain C, so that no exception and no C++ type crosses it.
#pragma once

extern "C" {

/// A picture to be written; `pixels` are rows from the top, channels interleaved.
struct GnomonImageSource {
  const char* path;  ///< its extension names the format: .png (8 bits, already encoded) or .exr (floats)
  int width, height, channels;
  const char* const* channelNames;  ///< null: the format's own
  const void* pixels;               ///< bytes for .png, floats for .exr
  int attributes;
  const char* const* attributeNames;
  const char* const* attributeValues;
};

/// Who reads a picture: is told of its attributes, then asked where the floats shall go (null: refused).
struct GnomonImageSink {
  void* context;
  void (*attribute)(void* context, const char* name, const char* value);
  float* (*pixels)(void* context, int width, int height, int channels, const char* const* channelNames);
};

/// 0, or 1 with a message in `error` (cut to `errorSize` bytes with its terminator).
typedef int GnomonImageWrite(const GnomonImageSource* source, char* error, unsigned long errorSize);
typedef int GnomonImageRead(const char* path, const GnomonImageSink* sink, char* error, unsigned long errorSize);

}  // extern "C"

namespace gnomon {
/// Names of the module's two functions.
inline constexpr const char* kImageWriteSymbol = "gnomon_image_write";  // GnomonImageWrite
inline constexpr const char* kImageReadSymbol = "gnomon_image_read";    // GnomonImageRead
}  // namespace gnomon
