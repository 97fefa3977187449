"""Forms of everyday sentences, each with what is right in the notation of tests/data/sentences.tsv."""

import pytest

from evaluation.everyday.notation import verdict
from evaluation.everyday.sentences import Sentence
from evaluation.everyday.understanding import understand


@pytest.mark.parametrize(
    ("context", "said", "right"),
    [
        # What is to be said, with a mark, to somebody, or as what somebody is to do.
        ("-", "shout dinner is on the table", "say(dinner is on the table)"),
        ("-", "announce, please: the bus is here", "say(the bus is here)"),
        ("-", "go to the desk and say knock knock", "goto(desk); say(knock knock)"),
        ("-", "tell the boys to brush their teeth", "say(brush your teeth)"),
        ("-", "ask the kids to come to the table", "say(come to the table)"),
        ("-", "say sweet dreams to him", "say(sweet dreams)"),
        ("-", "can you yell lunchtime so the girls hear it", "say(lunchtime)"),
        # How something is, with a short "is".
        ("-", "the red ball's flat, chuck it", "put(red ball, bin)"),
        ("-", "the milk's off, throw it away", "put(milk, bin)"),
        ("-", "the dog's lead is gone, find it", "find(dog's lead)"),
        # Where what is in the hand is to go, without a verb.
        ("held:green can", "bin, it's empty", "put(green can, bin)"),
        ("held:blue mug", "to the dresser, and gently please", "put(blue mug, dresser)"),
        ("held:red can", "counter for that", "put(red can, counter)"),
        ("held:apple", "desk, and after that you are free to go home", "put(apple, desk); return()"),
        # Beside each other is nearer than on the same surface.
        ("-", "stand the red can next to the yellow bowl", "put(red can, counter near yellow bowl)"),
        # What has been handed over needs no further coming.
        ("-", "bottle, the green one, over to me", "fetch(green bottle)"),
        ("-", "the red mug sits on the coffee table, bring it through would you", "fetch(red mug)"),
        ("-", "the apple lives on the counter, pop it back there please", "put(apple, counter)"),
        ("-", "my brother fancies a go with the red ball on the bookshelf, fetch it over", "fetch(red ball)"),
        (
            "-",
            "we're having supper at the kitchen table, so take the yellow bowl over there",
            "put(yellow bowl, kitchen table)",
        ),
        ("-", "playtime's over, the red ball goes in the toy box", "put(red ball, toy box)"),
        ("-", "the doctor is on her way: my vitamin box, please", "fetch(orange box)"),
        ("-", "bring me the green can that looks like a barrel", "fetch(green can)"),
        ("-", "put the apple on the desk and not the counter", "put(apple, desk)"),
        ("held:red mug", "dresser. carefully.", "put(red mug, dresser)"),
        ("-", "go to your corner then, dock", "return()"),
        ("busy:bring me the apple", "don't! leave the apple!", "stop()"),
        ("-", "ugh, that apple has gone all soft, bin it", "put(apple, bin)"),
        # Where to look for what was not found.
        ("failed:find my keys", "perhaps they fell behind something. check the bedroom", "goto(bedroom); find(keys)"),
        # Taken over from the hand, in whatever words; what the hand holds.
        ("held:red mug", "i'll take that off you, come", "fetch(red mug)"),
        ("held:apple", "hand over what you've got there", "fetch(apple)"),
        ("held:apple", "have you still got hold of the apple?", "answer(apple)"),
        # Said of where the robot is.
        ("last:go to the study", "now you're there get me the mug", "fetch(white mug)"),
        # Where a thing is to go, as a question or as a wonder.
        ("-", "could the green can go on the desk", "put(green can, desk)"),
        ("-", "i was wondering whether the box from the desk might find its way to me", "fetch(orange box)"),
        # All that is on one surface onto another, by number.
        ("-", "empty the desk: both things onto the counter", "put(white mug, counter) & put(orange box, counter)"),
        # A cry before a request, and one that only tells.
        ("-", "quick, a wasp! hand me the newspaper", "fetch(newspaper)"),
        ("-", "sorry, got a bee in my bonnet", "none()"),
        # What nobody can carry, and where nobody can go.
        ("-", "move the washing machine to the kitchen", "refuse()"),
        ("-", "pop over to the chemist for my pills", "none()"),
        # Where something is wanted from somewhere, and where it lies, however that is spelt.
        ("-", "let's have the spatula from the bookshelf on the kitchen table", "put(spatula, kitchen table)"),
        ("-", "pls bring me teh hair brush, its lying on the desk", "fetch(hair brush)"),
        # What names no place is the thing of what was suggested.
        ("heard:go to the bookshelf and bring me the hair brush", "the hairbrush", "fetch(hairbrush)"),
        # Known things in the plural are no kind.
        ("-", "my vitamins ought to be on the dresser rather than the desk", "put(orange box, dresser)"),
        ("-", "let my wife in the study know that lunch is ready", "goto(study); say(lunch is ready)"),
        ("-", "survey the room and remember everything", "look()"),
        # Several of a kind, told apart by their colours; things behind the name of their place.
        (
            "-",
            "both mugs please, the red to the desk and the blue to the kitchen table",
            "put(red mug, desk) & put(blue mug, kitchen table)",
        ),
        ("-", "the cans: green to me, red in the bin", "fetch(green can); put(red can, bin)"),
        ("-", "bring me the red mug and the blue", "fetch(red mug) & fetch(blue mug)"),
        ("-", "which one's taller, the green bottle or the white?", "answer(white)"),
        ("-", "which of the two cans is in the kitchen", "answer(red)"),
        ("-", "to the toy box: the red ball and the blue block", "put(red ball, toy box) & put(blue block, toy box)"),
        ("-", "rubbish: apple", "put(apple, bin)"),
        ("-", "that green can is warm, get it out of my sight", "put(green can, recycling bin)"),
        ("-", "off to your corner", "return()"),
        ("-", "go and park", "return()"),
        ("-", "we hereby name this place cape horn", "place(cape horn)"),
        ("-", "where you stand now shall be the parking bay", "place(parking bay)"),
        ("-", "please stop calling it vitamin box", "forget(vitamin box)"),
        ("-", "mugs don't go on the counter any more", "norule(mugs)"),
        ("-", "in five minutes' time go to the kitchen", "wait(300); goto(kitchen)"),
        ("-", "I've got eggs on the boil, so in four minutes go to the kitchen", "wait(240); goto(kitchen)"),
        ("last:bring me the apple", "which table did you get it from?", "answer(kitchen table)"),
        ("-", "list all the cans and where they are", "answer(living table, counter, dresser)"),
        # Speech goes on until the next command.
        (
            "-",
            "go to the kitchen, say hello, wait ten seconds and come back",
            "goto(kitchen); say(hello); wait(10); return()",
        ),
        # What for, and which thing that is.
        ("-", "i'd love a cold drink, the red can please", "fetch(red can)"),
        ("held:apple", "that goes by the name of Grandma's snack", "teach(Grandma's snack)"),
        # Called off in one part of what is said.
        ("busy:find my keys", "got them! you can call off the search", "stop()"),
        ("busy:bring me the apple", "cancel that! bring me the green can", "replace: fetch(green can)"),
        # Another of the same kind, by what people call it.
        ("last:put the red can in the recycling bin", "and its green mate an' all", "put(green can, recycling bin)"),
        ("busy:put the red ball in the toy box", "and then the blue block, please", "queue: put(blue block, toy box)"),
        ("-", "Of the two boxes I want the one that isn't on the desk.", "fetch(white box)"),
        ("-", "Right you, mug. The white one.", "fetch(white mug)"),
        ("-", "I'd like something to drink from, the mug on the desk will do.", "fetch(white mug)"),
        ("-", "Bring us the littlest brick, duck, the blue 'un.", "fetch(blue block)"),
        # Names and rules that are told, and taken back.
        ("-", "We call the red ball Bouncer in this family, just so you know.", "teach(bouncer)"),
        ("-", "The white mug? That's my lucky mug, remember that.", "teach(lucky mug)"),
        ("-", "The blue mug is Peter's mug, please remember.", "teach(peter's mug)"),
        ("-", "The blue mug is the dog's bed.", "none()"),
        ("-", "This green can's name shall be Lucky, okay?", "teach(lucky)"),
        ("-", "Nobody says vitamin box any more, so strike that name from your list.", "forget(vitamin box)"),
        ("-", "From now on, mugs belong on the counter.", "rule(mugs, counter)"),
        ("-", "In this house we keep the bowls on the kitchen table, please remember.", "rule(bowls, kitchen table)"),
        ("-", "Forget what I said about where cans go.", "norule(cans)"),
        ("-", "Scrap that thing about toys going in the toy box.", "norule(toys)"),
        # A way with stops; where each of several things is to go; beside each other; what is said twice.
        (
            "-",
            "Do the rounds: kitchen, bedroom, in that order, and then back here to me.",
            "goto(kitchen); goto(bedroom); return()",
        ),
        (
            "-",
            "Red mug: counter. White mug: kitchen table. Off you go.",
            "put(red mug, counter); put(white mug, kitchen table)",
        ),
        (
            "-",
            "The two bottles in the bedroom ought to be side by side, on the dresser say.",
            "put(green bottle, dresser)",
        ),
        (
            "-",
            "I'd like the blue bottle next to the green bottle.",
            "put(blue bottle, bedside table near green bottle)",
        ),
        (
            "-",
            "All the bottles go on the counter tonight, please move them there.",
            "put(green bottle, counter) & put(white bottle, counter)",
        ),
        (
            "last:put the white box on the bookshelf",
            "You know, it looked better where it was.",
            "put(white box, living table)",
        ),
        # What somebody would like, and what nobody can do anything for.
        ("-", "If you went and stood next to the nightstand I'd feel a good deal safer.", "goto(bedside table)"),
        ("-", "If only the bus would come.", "none()"),
        # Against what was heard.
        ("heard:tidy up the counter", "The counter? I was on about the kitchen table.", "tidy(kitchen table)"),
        ("heard:say lunch is ready", "Not lunch, supper is ready.", "say(supper is ready)"),
        ("heard:put the apple in the bin", "No, the apple is still good.", "no()"),
        # A question that begins like an announcement, or with where somebody stands.
        ("-", "Tell me, is there a single thing on that study shelf?", "answer(no)"),
        ("-", "What sits to the right of the red can when I'm facing the counter?", "answer(blue mug)"),
        ("-", "How many blocks did the kids leave lying around, all in all?", "answer(two|2)"),
        ("last:go to the bedroom", "What do you see there?", "answer(green bottle, white can, white bottle)"),
        ("held:blue block", "You needn't hold it any longer.", "drop()"),
        ("held:yellow bowl", "that's the popcorn bowl in this family, so learn to call it that", "teach(popcorn bowl)"),
        (
            "held:orange box",
            "Right beside the apple is where I want that.",
            "put(orange box, kitchen table near apple)",
        ),
        ("-", "Once you've put the soup on the counter you can go to the dock.", "put(white can, counter); return()"),
        ("-", "In a quarter of an hour I want the white can here.", "wait(900); fetch(white can)"),
        ("busy:go to the kitchen", "Please come back, I need you here after all.", "return()"),
        (
            "busy:bring me the red can",
            "Actually, scrap that, I'm off fizzy drinks. The blue bottle.",
            "replace: fetch(blue bottle)",
        ),
        ("-", "Some clown put my mug on the bookshelf, or no, it's on the desk.", "none()"),
        ("heard:put the apple in the bin", "Good grief, no, I still want to eat it!", "no()"),
    ],
)
def test_the_form_is_understood(context: str, said: str, right: str) -> None:
    sentence = Sentence(context, said, right)
    found = understand(sentence)
    assert verdict(sentence, found) == "right", found


def test_a_place_that_is_only_pointed_at_is_asked_about() -> None:
    found = understand(Sentence("-", "the visitors are here, take the red mug over there", "put(red mug, desk)"))
    assert not found.steps and "which place" in found.reason
