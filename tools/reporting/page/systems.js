// The graph of the systems: a click on one marks what it has data from and gives data to.
"use strict";

function followGraph(svg) {
  const nodes = new Map([...svg.querySelectorAll(".node")].map((node) => [titleOf(node), node]));
  const edges = [...svg.querySelectorAll(".edge")].map((edge) => ({ edge, ends: titleOf(edge).split("->") }));
  const details = svg.closest("figure").querySelector("pre");
  const choose = (name) => {
    const touching = edges.filter(({ ends }) => ends.includes(name));
    const marked = new Set([
      nodes.get(name),
      ...touching.flatMap(({ edge, ends }) => [edge, ...ends.map((end) => nodes.get(end))]),
    ]);
    for (const each of svg.querySelectorAll(".node, .edge")) {
      each.classList.toggle("dim", name !== null && !marked.has(each));
      each.classList.toggle("chosen", name !== null && marked.has(each));
    }
    details.textContent = name === null ? "" : nodes.get(name).querySelector("a").getAttribute("xlink:title");
    details.hidden = name === null;
  };
  for (const [name, node] of nodes) {
    node.setAttribute("tabindex", "0");
    node.addEventListener("keydown", (event) => event.key === "Enter" && node.dispatchEvent(new MouseEvent("click")));
    node.addEventListener("click", (event) => {
      event.preventDefault();
      event.stopPropagation();
      choose(node.classList.contains("chosen") && !details.hidden && details.dataset.of === name ? null : name);
      details.dataset.of = name;
    });
  }
  svg.addEventListener("click", () => choose(null));
  const holder = svg.parentElement;
  holder.scrollLeft = (holder.scrollWidth - holder.clientWidth) / 2; // the middle, where it is wider than the page
}

const titleOf = (group) => group.querySelector("title").textContent;

document.querySelectorAll("#graph svg").forEach(followGraph);
