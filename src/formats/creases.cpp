#include "formats/creases.h"

#include "settings/document.h"

#include <fmt/format.h>

#include <cmath>

namespace limn {

void readCreases(const std::filesystem::path& path, PolyMesh& mesh, std::vector<std::filesystem::path>* files) {
    const Node document = readDocument(path, files);
    ErrorCollector errors;
    for (const auto& [key, value] : document.table())
        if (key != "creases" && key != "corners")
            errors.add({ExitCode::badData, value.keyWhere, fmt::format("'{}' has no place in a file of creases", key),
                "it holds 'creases' and 'corners'"});
    const auto forEach = [&](std::string_view key, std::size_t vertices, auto&& use) {
        const Node* list = document.find(key);
        if (!list) return;
        if (!list->isArray())
            return errors.add({ExitCode::badData, list->where,
                fmt::format("'{}' must be a list, not {}", key, list->kindName()), ""});
        for (const auto& entry : list->array()) {
            std::vector<double> numbers;
            bool good = entry.isArray() && entry.array().size() == vertices + 1;
            for (std::size_t i = 0; good && i <= vertices; ++i) {
                const Node& item = entry.array()[i];
                numbers.push_back(item.number());
                good = item.isNumber() && item.number() >= 0
                    && (i == vertices
                        || (item.number() == std::floor(item.number())
                            && item.number() < static_cast<double>(mesh.positions.size())));
            }
            if (good)
                use(numbers);
            else
                errors.add({ExitCode::badData, entry.where,
                    fmt::format("an entry of '{}' is {} of the mesh's {} vertices, counted from 0, and a sharpness",
                        key, vertices == 1 ? "one" : "two", mesh.positions.size()),
                    ""});
        }
    };
    forEach("creases", 2, [&](const auto& n) {
        mesh.tags.creases.push_back(
            {static_cast<std::uint32_t>(n[0]), static_cast<std::uint32_t>(n[1]), static_cast<float>(n[2])});
    });
    forEach("corners", 1, [&](const auto& n) {
        mesh.tags.corners.push_back({static_cast<std::uint32_t>(n[0]), static_cast<float>(n[1])});
    });
    errors.throwIfAny();
}

}  // namespace limn
