//! Finds triangles that occur twice: the faces between neighbours.

/// Calls `pair` for two triangles with the same nodes and `alone` for a triangle that occurs once, with their
/// places in the list.
///
/// Triangles are grouped by their smallest node. Time and memory are proportional to the number of triangles.
pub(super) fn match_up(
    nodes: usize,
    triangles: impl Iterator<Item = [u32; 3]> + Clone,
    mut pair: impl FnMut(u32, u32),
    mut alone: impl FnMut(u32),
) {
    let mut ends = vec![0u32; nodes + 1];
    for [a, b, c] in triangles.clone() {
        ends[a.min(b).min(c) as usize + 1] += 1;
    }
    for i in 0..nodes {
        ends[i + 1] += ends[i];
    }
    // While the lists are filled, `ends[i]` moves from the start of list i to its end.
    let mut lists = vec![[0u32; 3]; ends[nodes] as usize];
    for (number, mut triangle) in triangles.enumerate() {
        triangle.sort_unstable();
        let [smallest, middle, largest] = triangle;
        let place = &mut ends[smallest as usize];
        lists[*place as usize] = [middle, largest, number as u32];
        *place += 1;
    }
    let mut start = 0;
    for end in ends.into_iter().take(nodes) {
        let list = &mut lists[start..end as usize];
        list.sort_unstable();
        let mut rest = &*list;
        while let Some((&[middle, largest, number], after)) = rest.split_first() {
            match after.first() {
                Some(&[m, l, other]) if (m, l) == (middle, largest) => {
                    pair(number, other);
                    rest = &after[1..];
                }
                _ => {
                    alone(number);
                    rest = after;
                }
            }
        }
        start = end as usize;
    }
}
