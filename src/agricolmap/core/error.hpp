// The library's errors, as its callers know them.
#pragma once

#include "agricolmap/error.hpp"
