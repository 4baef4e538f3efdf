// Precompiled for the command line: its two libraries take longer to parse than any command.
#pragma once
#include "pch.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
