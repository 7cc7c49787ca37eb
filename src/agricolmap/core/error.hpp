// The library's errors are public: its callers catch them. Rooms include them from here, as they do
// clouds, so that no room but this one knows which of its tools are public.
#pragma once

#include "agricolmap/error.hpp"
