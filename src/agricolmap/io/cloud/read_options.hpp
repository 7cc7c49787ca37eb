// What of a cloud's file is read.
#pragma once

namespace agricolmap::io {

struct ReadOptions {
  bool colours = true;  ///< read colours where the file has them
};

}  // namespace agricolmap::io
