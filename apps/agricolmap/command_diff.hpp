#pragma once
#include "common.hpp"
namespace agricolmap {
CommandSlot addDiffCommand(CLI::App& app, const Globals& globals);
}
