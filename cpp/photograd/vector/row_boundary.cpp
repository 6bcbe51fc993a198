#include "photograd/vector/row_boundary.h"

#include <algorithm>

namespace photograd {

void RowBoundary::find(const Contours& contours, std::span<const std::uint32_t> next,
                       std::span<const std::uint32_t> edges, std::int64_t row, FillRule rule) {
    pieces_.clear();
    take_edges(contours, next, edges, static_cast<double>(row));
    cut();
    active_.clear();
    std::size_t taken = 0;
    for (std::size_t k = 0; k + 1 < cuts_.size(); ++k) {
        const double top = cuts_[k], bottom = cuts_[k + 1];
        std::erase_if(active_, [&](const auto& each) { return edges_[each.second].y1 <= top; });
        for (; taken < edges_.size() && edges_[taken].y0 <= top; ++taken)
            active_.emplace_back(0.0, static_cast<std::uint32_t>(taken));
        toggle(rule, top, bottom);
    }
    // Horizontal edges, one level after the other.
    for (std::size_t first = 0, end = 0; first < horizontal_.size(); first = end) {
        const double y = contours.vertex(horizontal_[first]).y;
        while (end < horizontal_.size() && contours.vertex(horizontal_[end]).y == y) ++end;
        toggle_horizontal(contours, next, rule,
                          std::span<const std::uint32_t>(horizontal_).subspan(first, end - first));
    }
}

void RowBoundary::take_edges(const Contours& contours, std::span<const std::uint32_t> next,
                             std::span<const std::uint32_t> edges, double row) {
    edges_.clear();
    horizontal_.clear();
    for (const std::uint32_t edge : edges) {
        const Vec2<double> a = contours.vertex(edge), b = contours.vertex(next[edge]);
        if (a.y == b.y) {
            if (a.x != b.x) horizontal_.push_back(edge);
            continue;
        }
        const bool down = b.y > a.y;
        const Vec2<double> top = down ? a : b, bottom = down ? b : a;
        const double height = bottom.y - top.y;
        edges_.push_back({.edge = edge,
                          .direction = down ? 1 : -1,
                          .top = top,
                          .height = height,
                          .slope = (bottom.x - top.x) / height,
                          .y0 = std::max(top.y, row),
                          .y1 = std::min(bottom.y, row + 1),
                          .x_low = std::min(a.x, b.x),
                          .x_high = std::max(a.x, b.x),
                          .last_piece = -1});
    }
    std::sort(horizontal_.begin(), horizontal_.end(), [&](std::uint32_t i, std::uint32_t j) {
        return std::pair(contours.vertex(i).y, i) < std::pair(contours.vertex(j).y, j);
    });
}

/// Sorts edges_ by y0, and finds cuts_: ends and crossings, from top to bottom.
void RowBoundary::cut() {
    std::sort(edges_.begin(), edges_.end(), [](const RowEdge& a, const RowEdge& b) {
        return std::pair(a.x_low, a.edge) < std::pair(b.x_low, b.edge);
    });
    cuts_.clear();
    for (std::size_t i = 0; i < edges_.size(); ++i) {
        const RowEdge& a = edges_[i];
        cuts_.insert(cuts_.end(), {a.y0, a.y1});
        for (std::size_t j = i + 1; j < edges_.size() && edges_[j].x_low <= a.x_high; ++j) {
            const RowEdge& b = edges_[j];
            const double top = std::max(a.y0, b.y0), bottom = std::min(a.y1, b.y1);
            if (top >= bottom) continue;
            const double above = a.x_at(top) - b.x_at(top);
            const double below = a.x_at(bottom) - b.x_at(bottom);
            if ((above < 0 && below > 0) || (above > 0 && below < 0))
                cuts_.push_back(top + (bottom - top) * (above / (above - below)));
        }
    }
    std::sort(cuts_.begin(), cuts_.end());
    cuts_.erase(std::unique(cuts_.begin(), cuts_.end()), cuts_.end());
    std::sort(edges_.begin(), edges_.end(), [](const RowEdge& a, const RowEdge& b) {
        return std::pair(a.y0, a.edge) < std::pair(b.y0, b.edge);
    });
}

/// One strip: the active edges from left to right, and those at which the fill rule changes.
void RowBoundary::toggle(FillRule rule, double top, double bottom) {
    const double middle = 0.5 * (top + bottom);
    for (auto& [x, number] : active_) x = edges_[number].x_at(middle);
    // Nearly sorted, from the strip before.
    for (std::size_t i = 1; i < active_.size(); ++i)
        for (std::size_t j = i; j > 0 && active_[j] < active_[j - 1]; --j)
            std::swap(active_[j], active_[j - 1]);
    int winding = 0;
    for (const auto& each : active_) {
        RowEdge& edge = edges_[each.second];
        const bool before = is_inside(rule, winding);
        winding += edge.direction;
        const bool after = is_inside(rule, winding);
        // A motion to the right takes area where the shape begins: -1 for an edge that goes down.
        if (before != after) add_piece(edge, top, bottom, (after ? -1.0 : 1.0) * edge.direction);
    }
}

void RowBoundary::add_piece(RowEdge& edge, double top, double bottom, double sign) {
    const double at_top = (top - edge.top.y) / edge.height;
    const double at_bottom = (bottom - edge.top.y) / edge.height;
    const bool down = edge.direction > 0;
    if (edge.last_piece >= 0) {
        BoundaryPiece& last = pieces_[static_cast<std::size_t>(edge.last_piece)];
        if (last.y1 == top && last.sign == sign) {
            last.y1 = bottom;
            (down ? last.t1 : last.t0) = down ? at_bottom : 1 - at_bottom;
            return;
        }
    }
    edge.last_piece = static_cast<std::int64_t>(pieces_.size());
    pieces_.push_back({.edge = edge.edge,
                       .t0 = down ? at_top : 1 - at_bottom,
                       .t1 = down ? at_bottom : 1 - at_top,
                       .y0 = top,
                       .y1 = bottom,
                       .sign = sign});
}

/// The pieces of horizontal edges at one height that bound the shape: from below to above, the
/// winding number grows by 1 across an edge to the right, and falls across one to the left.
void RowBoundary::toggle_horizontal(const Contours& contours, std::span<const std::uint32_t> next,
                                    FillRule rule, std::span<const std::uint32_t> level) {
    const double y = contours.vertex(level[0]).y;
    std::vector<double> ends;
    std::vector<std::pair<double, int>> below;  // x at y, direction
    for (const std::uint32_t edge : level)
        ends.insert(ends.end(), {contours.vertex(edge).x, contours.vertex(next[edge]).x});
    for (const RowEdge& edge : edges_)
        if (edge.y0 <= y && edge.y1 > y) below.emplace_back(edge.x_at(y), edge.direction);
    for (const auto& each : below) ends.push_back(each.first);
    std::sort(ends.begin(), ends.end());
    std::sort(below.begin(), below.end());
    int from_left = 0;
    std::size_t passed = 0;
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
        for (; passed < below.size() && below[passed].first <= ends[k]; ++passed)
            from_left += below[passed].second;
        if (ends[k] == ends[k + 1]) continue;
        int winding = from_left;
        for (const std::uint32_t edge : level) {
            const double a = contours.vertex(edge).x, b = contours.vertex(next[edge]).x;
            if (std::min(a, b) > ends[k] || std::max(a, b) < ends[k + 1]) continue;
            const bool lower = is_inside(rule, winding);
            winding += b > a ? 1 : -1;
            const bool upper = is_inside(rule, winding);
            if (lower == upper) continue;
            const double t0 = (ends[k] - a) / (b - a), t1 = (ends[k + 1] - a) / (b - a);
            // A motion downward takes area where the shape lies below.
            pieces_.push_back({.edge = edge,
                               .t0 = std::min(t0, t1),
                               .t1 = std::max(t0, t1),
                               .y0 = y,
                               .y1 = y,
                               .sign = (lower ? 1.0 : -1.0) * (b > a ? 1.0 : -1.0)});
        }
    }
}

}  // namespace photograd
