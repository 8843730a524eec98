// SPDX-License-Identifier: MIT
#include "batch/merge.h"

#include <array>
#include <string_view>
#include <vector>

#include "common/length.h"
#include "common/output.h"

namespace meshbound::tools {
namespace {

using Json = nlohmann::ordered_json;

/// A column of the table: its name with the unit, and the text for an asset.
struct Column {
  const char* name;
  bool is_number;
  std::string (*cell)(const AssetRecord&);
};

/// A number of the tool's document; empty where that has none.
std::string number_at(const AssetRecord& record, const char* pointer) {
  const Json::json_pointer at(pointer);
  if (!record.result.contains(at) || !record.result[at].is_number()) return "";
  const Json& value = record.result[at];
  return value.is_number_integer() ? std::to_string(value.get<std::int64_t>()) : exact_number(value.get<double>());
}

constexpr double mebibyte = 1024 * 1024;

constexpr std::array columns{
    Column{"input", false, [](const AssetRecord& r) { return r.input; }},
    Column{"status", false, [](const AssetRecord& r) { return r.status; }},
    Column{"faces before", true, [](const AssetRecord& r) { return number_at(r, "/original/faces"); }},
    Column{"faces after", true, [](const AssetRecord& r) { return number_at(r, "/simplified/faces"); }},
    Column{"tolerance", true, [](const AssetRecord& r) { return number_at(r, "/tolerance/absolute"); }},
    Column{"distance lower", true, [](const AssetRecord& r) { return number_at(r, "/distance/lower"); }},
    Column{"distance upper", true, [](const AssetRecord& r) { return number_at(r, "/distance/upper"); }},
    Column{"seconds", true, [](const AssetRecord& r) { return short_number(r.seconds); }},
    Column{"CPU seconds", true, [](const AssetRecord& r) { return short_number(r.cpu_seconds); }},
    Column{"memory MiB", true,
           [](const AssetRecord& r) { return short_number(static_cast<double>(r.peak_memory) / mebibyte); }},
    Column{"message", false, [](const AssetRecord& r) { return r.message; }},
};

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string csv_name(std::string_view name) {
  std::string text(name);
  for (char& c : text)
    if (c == ' ') c = '_';
  return text;
}

std::string to_csv(const std::map<std::string, AssetRecord>& records) {
  std::string text;
  const auto end_cell = [&text](const Column& column) { text += &column == &columns.back() ? '\n' : ','; };
  for (const Column& column : columns) {
    text += csv_name(column.name);
    end_cell(column);
  }
  for (const auto& [name, record] : records)
    for (const Column& column : columns) {
      text += csv_cell(column.cell(record));
      end_cell(column);
    }
  return text;
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  return result;
}

constexpr std::string_view page_begin = R"(<!DOCTYPE html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Batch of simplify_with_bound</title>
<style>
  :root { color-scheme: light dark; font: 15px/1.4 system-ui, sans-serif; }
  body { margin: 2rem; }
  .table { overflow-x: auto; }
  table { border-collapse: collapse; white-space: nowrap; }
  th, td { padding: 0.25rem 0.75rem; border-bottom: 1px solid #8886; text-align: left; }
  td.number { text-align: right; font-variant-numeric: tabular-nums; }
  th button { all: unset; cursor: pointer; font-weight: bold; }
  th button:focus-visible { outline: 2px solid; }
  .within { color: light-dark(#06662a, #6fdc93); }
  .exceeds, .failed { color: light-dark(#a40f16, #ff9a9a); }
  .undecided { color: light-dark(#7a5200, #f2c56b); }
</style>
<h1>Batch of simplify_with_bound</h1>
)";

constexpr std::string_view page_end = R"(</table></div>
<script>
  for (const [column, button] of document.querySelectorAll("th button").entries()) {
    let direction = 1;
    button.addEventListener("click", () => {
      const body = document.querySelector("tbody");
      const key = row => row.cells[column].textContent;
      const compare = row => row.cells[column].className === "number" ? Number(key(row) || NaN) : key(row);
      const order = (a, b) => a === b ? 0 : a < b || Number.isNaN(b) ? -1 : 1;
      const rows = [...body.rows].sort((a, b) => direction * order(compare(a), compare(b)));
      body.append(...rows);
      direction = -direction;
    });
  }
</script>
)";

std::string to_html(const std::map<std::string, AssetRecord>& records) {
  const BatchCounts counts = count_by_status(records);
  std::string page(page_begin);
  page += "<p>" + std::to_string(counts.all()) + " meshes: <span class=\"within\">" + std::to_string(counts.within) +
          " within</span>, <span class=\"exceeds\">" + std::to_string(counts.exceeds) +
          " exceed</span>, <span class=\"undecided\">" + std::to_string(counts.undecided) +
          " undecided</span>, <span class=\"failed\">" + std::to_string(counts.failed) +
          " failed</span>. Lengths are in model units; distance is the symmetric Hausdorff distance between a mesh and "
          "its result as written, and lies between lower and upper.</p>\n<div class=\"table\"><table>\n<thead><tr>";
  for (const Column& column : columns) page += "<th><button>" + std::string(column.name) + "</button></th>";
  page += "</tr></thead>\n<tbody>\n";
  for (const auto& [name, record] : records) {
    page += "<tr class=\"" + escaped(record.status) + "\">";
    for (const Column& column : columns)
      page += (column.is_number ? "<td class=\"number\">" : "<td>") + escaped(column.cell(record)) + "</td>";
    page += "</tr>\n";
  }
  page += "</tbody>";
  page += page_end;
  return page;
}

}  // namespace

BatchCounts count_by_status(const std::map<std::string, AssetRecord>& records) {
  BatchCounts counts;
  for (const auto& [name, record] : records)
    ++(record.status == "within"      ? counts.within
       : record.status == "exceeds"   ? counts.exceeds
       : record.status == "undecided" ? counts.undecided
                                      : counts.failed);
  return counts;
}

void write_tables(const std::filesystem::path& folder, const std::map<std::string, AssetRecord>& records) {
  write_text((folder / "batch.csv").string(), to_csv(records));
  write_text((folder / "batch.html").string(), to_html(records));
}

}  // namespace meshbound::tools
