#pragma once

#include "bench/stream_run.h"

#include <filesystem>
#include <vector>

namespace atlaswire::bench {

/// Tables in Markdown, to standard output; `moves`: with columns of motion.
void print_head(bool moves);
void print_row(const Row& row, bool moves);

/// All rows with a field a figure: `stream`, `codec`, octets as `..._bytes`, milliseconds as `..._ms`. Encode
/// and decode include motion. Throws std::runtime_error where the file cannot be written.
void write_csv(const std::vector<Row>& rows, const std::filesystem::path& file);
/// The same as an array of objects.
void write_json(const std::vector<Row>& rows, const std::filesystem::path& file);

}  // namespace atlaswire::bench
